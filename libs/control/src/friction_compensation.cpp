#include "crane/control/friction_compensation.hpp"

#include <algorithm>
#include <cmath>

namespace crane::control {
namespace {

double moving_v(const DriveFriction& friction, double speed) noexcept {
  if (speed > 0) return friction.coulomb_positive_v + friction.viscous_positive_vspm * speed;
  return -friction.coulomb_negative_v + friction.viscous_negative_vspm * speed;
}

double resting_v(const DriveFriction& friction, double control_v) noexcept {
  const double level = control_v > 0 ? friction.stiction_positive_v : friction.stiction_negative_v;
  return level * std::tanh(friction.stiction_slope_per_v * control_v);
}

}  // namespace

double friction_compensation_v(const DriveFriction& friction, double control_v, double speed) noexcept {
  constexpr double kFastest = 1e6;  // no finite speed may overflow
  const double bounded_speed = std::clamp(speed, -kFastest, kFastest);
  const bool moving = std::abs(bounded_speed) > friction.zero_band_mps;
  return friction.factor * (moving ? moving_v(friction, bounded_speed) : resting_v(friction, control_v));
}

}  // namespace crane::control
