#include "run_checks.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace crane::identification {

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

void require_positive(const char* name, double value) {
  if (!(value > 0)) throw std::invalid_argument(std::string{name} + " = " + text(value) + ": must be > 0");
}

void check_series(const AxisRun& run) {
  constexpr std::size_t kFewestSamples = 100;
  require_positive("period_s", run.period_s);
  const std::size_t samples = run.position.size();
  if (run.drive_v.size() != samples || (!run.speed.empty() && run.speed.size() != samples))
    throw IdentificationError("position, drive_v and speed differ in length");
  if (samples < kFewestSamples)
    throw IdentificationError("only " + std::to_string(samples) + " samples: at least " +
                              std::to_string(kFewestSamples) + " are needed");
  for (const auto* series : {&run.position, &run.drive_v, &run.speed})
    if (!std::ranges::all_of(*series, [](double value) { return std::isfinite(value); }))
      throw IdentificationError("the run has samples that are not finite: give a run without gaps");
}

}  // namespace crane::identification
