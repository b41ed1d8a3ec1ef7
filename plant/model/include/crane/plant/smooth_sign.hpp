#pragma once
/// Smooth sign of the speed for dry friction: tanh(v / v_s).
#include <cmath>

namespace crane::plant {

/// Above 20 v_s the result is +-1 in double precision; this common case avoids the evaluation of tanh.
[[nodiscard]] inline double smooth_sign(double speed, double smoothing_speed) {
  const double ratio = speed / smoothing_speed;
  return std::abs(ratio) > 20 ? std::copysign(1.0, ratio) : std::tanh(ratio);
}

}  // namespace crane::plant
