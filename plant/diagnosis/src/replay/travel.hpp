#pragma once
/// Range of measured values.
#include <algorithm>
#include <limits>
#include <vector>

#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double value) { low = std::min(low, value), high = std::max(high, value); }
  [[nodiscard]] double width() const { return high - low; }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

/// Over all runs. The width is negative when no run has the output.
[[nodiscard]] inline Extent travel_of(const std::vector<PreparedRun>& runs, Output output) {
  Extent travel;
  for (const PreparedRun& run : runs)
    for (const double value : run.run.measured[output]) travel.take(value);
  return travel;
}

}  // namespace crane::diagnosis
