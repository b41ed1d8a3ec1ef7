#include "crane/configuration/encoder_resolution.hpp"

#include <algorithm>

#include "crane/fields/shortest.hpp"
#include "crane/plant/coordinates.hpp"
#include "section_reader.hpp"

namespace crane::configuration {

double least_counts_per_unit(const Drive& drive, double period_s) noexcept {
  const double coarsest_step = (kBridgeSpeedMargin - 1) * drive.max_speed * period_s;
  return std::max(1 / drive.brake_slip, 1 / coarsest_step);
}

void require_resolved_speeds(const Rig& rig) {
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < rig.drives.size(); ++i) {
    if (!rig.drives[i].present) continue;
    const double counts = rig.encoders[i].counts_per_unit;
    const double least = least_counts_per_unit(rig.drives[i], rig.period_s);
    if (counts >= least) continue;
    const plant::Coordinate& axis = plant::kCoordinates[i];
    problems.push_back(rig.path + ": encoder." + axis.name + ".counts_per_" + axis.unit + " = " +
                       fields::shortest(counts) + ": must be at least " + fields::shortest(least) +
                       " in a control loop: one count must not exceed a tenth of the distance that the axis "
                       "travels at max_speed in one period");
  }
  if (!problems.empty()) throw ConfigurationError{std::move(problems)};
}

}  // namespace crane::configuration
