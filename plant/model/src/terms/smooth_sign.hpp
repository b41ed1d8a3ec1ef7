#pragma once
/// The step of dry friction at standstill, smoothed: tanh(v / v_s).
#include <cmath>

namespace crane::plant {

/// Beyond 20 v_s the hyperbolic tangent is 1 in double precision; most of the time a crane moves that fast.
[[nodiscard]] inline double smooth_sign(double speed, double smoothing_speed) {
  const double ratio = speed / smoothing_speed;
  return std::abs(ratio) > 20 ? std::copysign(1.0, ratio) : std::tanh(ratio);
}

}  // namespace crane::plant
