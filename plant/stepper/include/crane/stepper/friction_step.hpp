#pragma once
/// One step of one axis with stiff friction: v' = a - g f(v), f in V. f is nearly odd and steep at v = 0.
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

namespace crane::stepper {

/// m/s or rad/s: below this speed, the steep friction at standstill is integrated implicitly.
inline constexpr double kImplicitSpeed = 0.004;
/// m/s or rad/s: a slower axis is at rest. A step in which a faster axis reverses is divided at standstill.
inline constexpr double kRestSpeed = 2e-4;

/// m/s or rad/s: above this speed the simulation has diverged, and rounding would make the bracket of the
/// root empty.
inline constexpr double kDivergedSpeed = 1e6;

struct FrictionStep {
  double speed = 0;     ///< at the end of the step [m/s or rad/s]
  double distance = 0;  ///< covered in the step [m or rad]
  double friction = 0;  ///< mean over the step [V]
};

/// Root v of the increasing function v + k f(v) - c, with an error of at most 1e-9.
/// @param near  initial guess of v
/// @param friction_near  f(near)
template <class Friction>
double implicit_speed(double c, double k, Friction&& friction, double near, double friction_near) {
  constexpr double kExact = 1e-9, kNear = 1e-5;
  /// The first step changes the speed by this share of the excess. The slope of the function is at
  /// least 1, and about 100 where dry friction holds an axis.
  constexpr double kFirstShare = 0.01;
  constexpr int kSecants = 5;
  if (!(std::abs(c) < kDivergedSpeed && std::abs(near) < kDivergedSpeed)) return c;
  // Where the friction increases, the slope of the function is at least 1: |excess| bounds the error of v.
  const auto excess = [&](double v) { return v + k * friction(v) - c; };
  const double at_near = near + k * friction_near - c;
  if (std::abs(at_near) < kExact) return near;
  double before = near, at_before = at_near, now = near - kFirstShare * at_near;
  for (int secant = 0; secant < kSecants; ++secant) {
    const double at_now = excess(now), slope = (at_now - at_before) / (now - before);
    if (std::abs(at_now) < kExact) return now;
    if (!(slope >= 1)) break;
    before = now, at_before = at_now, now -= at_now / slope;
  }
  double low = near, high = near, at_low = at_near, at_high = at_near;
  if (at_near > 0) {
    low = near - kNear, at_low = excess(low);
    if (at_low > 0)
      high = low, at_high = at_low, low = std::min({c, 0.0, near}) - kImplicitSpeed, at_low = excess(low);
  } else {
    high = near + kNear, at_high = excess(high);
    if (at_high < 0)
      low = high, at_low = at_high, high = std::max({c, 0.0, near}) + kImplicitSpeed, at_high = excess(high);
  }
  for (int grown = 0; at_low > 0 && grown < 20; ++grown) low *= 2, at_low = excess(low);
  for (int grown = 0; at_high < 0 && grown < 20; ++grown) high *= 2, at_high = excess(high);
  if (at_low >= 0) return low;
  if (at_high <= 0) return high;
  std::uintmax_t rounds = 40;
  const auto close = [](double a, double b) { return b - a < kExact; };
  const auto root = boost::math::tools::toms748_solve(excess, low, high, at_low, at_high, close, rounds);
  return 0.5 * (root.first + root.second);
}

/// The same with the initial guess 0.
template <class Friction>
double implicit_speed(double c, double k, Friction&& friction) {
  return implicit_speed(c, k, friction, 0.0, friction(0.0));
}

/// @param v         speed at the start of the step [m/s or rad/s]
/// @param a         acceleration without friction [m/s2 or rad/s2]
/// @param g         deceleration per volt of friction [m/s2 or rad/s2 per V]
/// @param h         length of the step [s]
/// @param friction  friction at a speed [V]
template <class Friction>
FrictionStep friction_step(double v, double a, double g, double h, Friction&& friction) {
  const double at_start = friction(v), slope = a - g * at_start;
  if (std::abs(v) > kImplicitSpeed) {
    const double middle = v + 0.5 * h * slope, f = friction(middle), end = v + h * (a - g * f);
    if (middle * v > 0 && end * v > 0 && std::abs(end) > kImplicitSpeed) return {end, 0.5 * h * (v + end), f};
  }
  if (std::abs(v) > kRestSpeed && v * slope < 0 && std::abs(v) < h * std::abs(slope)) {
    const double remaining = h + v / slope;  // part of the step after the standstill [s]
    const double after = implicit_speed(remaining * a, remaining * g, friction);
    const double mean_friction = h * g != 0 ? (v + h * a - after) / (h * g) : 0;
    return {after, 0.5 * v * (h - remaining) + 0.5 * after * remaining, mean_friction};
  }
  const double end = implicit_speed(v + h * a, h * g, friction, v, at_start);
  const double mean_friction = h * g != 0 ? (v + h * a - end) / (h * g) : 0;
  return {end, 0.5 * h * (v + end), mean_friction};
}

}  // namespace crane::stepper
