#include "crane/identification/break_away.hpp"

#include <algorithm>
#include <cmath>

#include "run_checks.hpp"

namespace crane::identification {
namespace {

Stiction stiction_of(const std::vector<double>& volts, const char* direction) {
  if (volts.size() < kFewestBreakAways)
    throw IdentificationError(
        "only " + std::to_string(volts.size()) + " break-aways in the " + direction +
        " direction: " + std::to_string(kFewestBreakAways) +
        " are needed; raise the voltage slowly from rest, several times in both directions");
  const double count = static_cast<double>(volts.size());
  double mean = 0, squares = 0;
  for (const double v : volts) mean += v / count;
  for (const double v : volts) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / (count - 1)), volts.size()};
}

}  // namespace

std::vector<BreakAway> break_aways(const AxisRun& run, const BreakAwayOptions& options) {
  require_positive("start_speed", options.start_speed);
  require_positive("rest_s", options.rest_s);
  require_positive("window_s", options.window_s);
  check_series(run);
  const auto samples = [&run](double time_s) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(time_s / run.period_s)));
  };
  const std::size_t window = samples(options.window_s), rest = samples(options.rest_s);
  std::vector<BreakAway> found;
  std::size_t resting = 0;
  for (std::size_t k = window; k < run.position.size(); ++k) {
    const double speed =
        (run.position[k] - run.position[k - window]) / (static_cast<double>(window) * run.period_s);
    if (std::abs(speed) < options.start_speed) {
      ++resting;
      continue;
    }
    const std::size_t middle = k - window / 2;
    if (resting >= rest && speed * run.drive_v[middle] > 0)
      found.push_back({static_cast<double>(middle) * run.period_s, run.drive_v[middle]});
    resting = 0;
  }
  return found;
}

StictionEstimate estimate_stiction(const AxisRun& run, const BreakAwayOptions& options) {
  std::vector<double> positive, negative;
  for (const BreakAway& start : break_aways(run, options))
    (start.drive_v > 0 ? positive : negative).push_back(std::abs(start.drive_v));
  return {stiction_of(positive, "positive"), stiction_of(negative, "negative")};
}

}  // namespace crane::identification
