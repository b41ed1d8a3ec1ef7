#pragma once
#include <algorithm>
#include <vector>

namespace crane::diagnosis {

/// Standard deviation of a normal variable with mean 0 over the median of its absolute value.
inline constexpr double kNormalPerMedian = 1.4826;

/// Upper median. @pre not empty
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace crane::diagnosis
