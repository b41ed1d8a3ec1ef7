#pragma once
#include <boost/math/special_functions/erf.hpp>
#include <numbers>

namespace crane::diagnosis {

/// Value that a standard normal variable exceeds with probability `p`, 0 < p < 1.
[[nodiscard]] inline double upper_quantile(double p) {
  return std::numbers::sqrt2 * boost::math::erfc_inv(2 * p);
}

}  // namespace crane::diagnosis
