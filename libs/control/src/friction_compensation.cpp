#include "crane/control/friction_compensation.hpp"

#include <algorithm>
#include <cmath>

namespace crane::control {
namespace {

// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes (friction_compensation.hpp).

/// (3.1), corrected signs.
double moving_v(const DriveFriction& friction, double speed) noexcept {
  if (speed > 0) return friction.coulomb_positive_v + friction.viscous_positive_vspm * speed;
  return -friction.coulomb_negative_v + friction.viscous_negative_vspm * speed;
}

/// (3.2) with the value 0 at control_v = 0.
double resting_v(const DriveFriction& friction, double control_v) noexcept {
  const double level = control_v > 0 ? friction.stiction_positive_v : friction.stiction_negative_v;
  return level * std::tanh(friction.stiction_slope_per_v * control_v);
}

}  // namespace

double friction_compensation_v(const DriveFriction& friction, double control_v, double speed) noexcept {
  constexpr double kSpeedBound = 1e6;  // prevents an overflow for every finite speed
  const double bounded_speed = std::clamp(speed, -kSpeedBound, kSpeedBound);
  const bool moving = std::abs(bounded_speed) > friction.zero_band_mps;  // (3.3)
  return friction.factor * (moving ? moving_v(friction, bounded_speed) : resting_v(friction, control_v));
}

}  // namespace crane::control
