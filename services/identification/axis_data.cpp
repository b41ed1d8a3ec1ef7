#include "identification/axis_data.hpp"

#include <cmath>
#include <numeric>
#include <optional>

#include "crane/control/schedule.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::identification {
namespace {

using identification::IdentificationError;

const std::vector<double>& column(const recording::Table& table, const char* name) {
  const auto* found = table.find(name);
  if (found == nullptr) throw IdentificationError(std::string{"the run has no column "} + name);
  return *found;
}

/// Value of the column; 0 when the rig does not measure it.
double value_of(const std::vector<double>* values, std::size_t row) {
  return values == nullptr || !std::isfinite((*values)[row]) ? 0 : (*values)[row];
}

/// True when `row` is the next tick after `last`, even if latched late; without a column tick, when `row` is
/// one period later.
bool follows(const recording::Table& table, std::size_t last, std::size_t row, double period_s) {
  if (const auto* tick = table.find("tick")) return (*tick)[row] == (*tick)[last] + 1;
  constexpr double kUneven = 0.1;  // largest deviation of the interval from one period, share of the period
  const auto& time_s = column(table, "time_s");
  return std::abs(time_s[row] - time_s[last] - period_s) <= kUneven * period_s;
}

}  // namespace

identification::AxisRun axis_run_from(const recording::Table& table, const configuration::Rig& rig,
                                      std::size_t axis, double from_s, double to_s) {
  const auto& time_s = column(table, "time_s");
  const auto& position = column(table, plant::kCoordinates[axis].column);
  const auto& drive_v = column(table, plant::kCoordinates[axis].command_v);
  const auto* trolley_m = table.find(plant::kCoordinates[plant::kTrolley].column);
  const auto* radial_rad = table.find(plant::kCoordinates[plant::kSwingRadial].column);
  const auto* tangential_rad = table.find(plant::kCoordinates[plant::kSwingTangential].column);
  identification::AxisRun run;
  run.period_s = rig.period_s;
  std::optional<std::size_t> last;
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    if (time_s[row] < from_s || time_s[row] > to_s) continue;
    if (last && !follows(table, *last, row, rig.period_s))
      throw IdentificationError("rows at " + std::to_string(time_s[*last]) + " s and " +
                                std::to_string(time_s[row]) +
                                " s are not one period apart: give a run without gaps");
    last = row;
    control::Measurement measured;
    measured.position[plant::kTrolley] = value_of(trolley_m, row);
    measured.swing_radial_rad = value_of(radial_rad, row);
    measured.swing_tangential_rad = value_of(tangential_rad, row);
    run.position.push_back(position[row]);
    run.drive_v.push_back(drive_v[row] - control::load_force_volts(rig.design.crane, measured)[axis]);
  }
  return run;
}

double mean_trolley_position(const recording::Table& table) {
  const auto* trolley_m = table.find("trolley_position_m");
  if (trolley_m == nullptr || trolley_m->empty()) return 0;
  return std::accumulate(trolley_m->begin(), trolley_m->end(), 0.0) / static_cast<double>(trolley_m->size());
}

double acting_gain(const control::Design& design, std::size_t axis, double trolley_position_m) {
  if (axis == plant::kTrolley) return design.crane.trolley_gain_mps2pv;
  return design.crane.slew_gain_radps2pv /
         (1 + design.crane.trolley_to_jib_ratio() * trolley_position_m * trolley_position_m);
}

}  // namespace crane::identification
