#include "crane/control/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "require.hpp"

namespace crane::control {
namespace {

constexpr double kLargest = 1e9, kSmallest = 1e-9;  // ranges of trajectory.hpp; no overflow within them

void require_ends(Requirements& rules, double start, double target) {
  rules.in_range("start", start, -kLargest, kLargest);
  rules.in_range("target", target, -kLargest, kLargest);
}

/// One ramp; all values are positive.
struct Ramp {
  double speed;         ///< final speed
  double acceleration;  ///< largest acceleration
  double ramp_s;        ///< duration
  double jerk_s;        ///< duration of constant jerk at either end
};

Ramp to_full_speed(const AxisLimits& limits) {
  const double jerk_s = limits.acceleration / limits.jerk;
  if (limits.speed >= limits.acceleration * jerk_s)
    return {limits.speed, limits.acceleration, limits.speed / limits.acceleration + jerk_s, jerk_s};
  const double short_s = std::sqrt(limits.speed / limits.jerk);
  return {limits.speed, limits.jerk * short_s, 2 * short_s, short_s};
}

/// Ramp of a move that decelerates immediately after the acceleration.
Ramp of_short_move(const AxisLimits& limits, double distance) {
  const double jerk_s = limits.acceleration / limits.jerk;
  if (distance >= 2 * limits.acceleration * jerk_s * jerk_s) {
    const double root_s = std::sqrt(jerk_s * jerk_s + 4 * distance / limits.acceleration);
    const double equivalent_s = (root_s - jerk_s) / 2;  // final speed / full acceleration
    return {limits.acceleration * equivalent_s, limits.acceleration, equivalent_s + jerk_s, jerk_s};
  }
  const double short_s = std::cbrt(distance / (2 * limits.jerk));
  const double acceleration = limits.jerk * short_s;
  return {acceleration * short_s, acceleration, 2 * short_s, short_s};
}

}  // namespace

/// Reference of the first half of the move, relative to `start`.
AxisReference AxisProfile::first_half(double time_s) const noexcept {
  if (time_s >= ramp_s) return {speed * (time_s - ramp_s / 2), speed, 0};
  if (time_s < jerk_s) {
    const double jerk = acceleration / jerk_s;
    return {jerk * time_s * time_s * time_s / 6, jerk * time_s * time_s / 2, jerk * time_s};
  }
  const double left_s = ramp_s - time_s;
  if (left_s < jerk_s) {
    const double jerk = acceleration / jerk_s;
    return {speed * (time_s - ramp_s / 2) + jerk * left_s * left_s * left_s / 6,
            speed - jerk * left_s * left_s / 2, jerk * left_s};
  }
  const double even_s = time_s - jerk_s / 2;
  return {acceleration * (even_s * even_s / 2 + jerk_s * jerk_s / 24), acceleration * even_s, acceleration};
}

AxisReference AxisProfile::at(double time_s) const noexcept {
  if (time_s < 0) return {start, 0, 0};
  const double remaining_s = duration_s() - time_s;
  if (remaining_s <= 0) return {target, 0, 0};
  if (time_s <= remaining_s) {
    const AxisReference rise = first_half(time_s);
    return {start + rise.position, rise.speed, rise.acceleration};
  }
  const AxisReference rise = first_half(remaining_s);  // the second half mirrors the first
  return {target - rise.position, rise.speed, -rise.acceleration};
}

AxisProfile step_profile(double start, double target) noexcept { return {start, target, 0, 0, 0, 0, 0}; }

AxisProfile limited_profile(double start, double target, const AxisLimits& limits) {
  Requirements rules;
  require_ends(rules, start, target);
  rules.in_range("speed", limits.speed, kSmallest, kLargest);
  rules.in_range("acceleration", limits.acceleration, kSmallest, kLargest);
  if (!std::isinf(limits.jerk) || limits.jerk < 0) rules.in_range("jerk", limits.jerk, kSmallest, kLargest);
  rules.throw_if_any();
  const double distance = std::abs(target - start), sign = target < start ? -1 : 1;
  const Ramp full = to_full_speed(limits);
  const bool coasts = distance >= full.speed * full.ramp_s;
  const Ramp ramp = coasts ? full : of_short_move(limits, distance);
  return {start,
          target,
          ramp.ramp_s,
          coasts ? distance / full.speed - full.ramp_s : 0,
          sign * ramp.speed,
          sign * ramp.acceleration,
          ramp.jerk_s};
}

AxisProfile timed_profile(double start, double target, double final_time_s, double ramp_s, double jerk_s) {
  Requirements rules;
  require_ends(rules, start, target);
  rules.in_range("ramp_s", ramp_s, kSmallest, kLargest);
  rules.require(final_time_s <= 2 * kLargest && final_time_s >= 2 * ramp_s, "final_time_s", final_time_s,
                "must be at least two ramps");
  rules.require(jerk_s == 0 || (jerk_s >= kSmallest && 2 * jerk_s <= ramp_s), "jerk_s", jerk_s,
                "must be 0, or at least 1e-09 and at most half a ramp");
  rules.throw_if_any();
  const double speed = (target - start) / (final_time_s - ramp_s);
  return {start, target, ramp_s, final_time_s - 2 * ramp_s, speed, speed / (ramp_s - jerk_s), jerk_s};
}

AxisProfile stretched(const AxisProfile& profile, double duration_s) noexcept {
  if (!(profile.duration_s() > 0) || duration_s <= profile.duration_s()) return profile;
  const double scale = duration_s / profile.duration_s();
  AxisProfile result = profile;
  result.ramp_s *= scale;
  result.coast_s *= scale;
  result.jerk_s *= scale;
  result.speed /= scale;
  result.acceleration /= scale * scale;
  return result;
}

Trajectory synchronised(Trajectory trajectory) noexcept {
  const double longest_s = duration_s(trajectory);
  for (auto& axis : trajectory) axis = stretched(axis, longest_s);
  return trajectory;
}

double duration_s(const Trajectory& trajectory) noexcept {
  double longest_s = 0;
  for (const auto& axis : trajectory) longest_s = std::max(longest_s, axis.duration_s());
  return longest_s;
}

Reference reference_at(const Trajectory& trajectory, double time_s) noexcept {
  Reference result;
  for (std::size_t axis = 0; axis < kAxes; ++axis) result[axis] = trajectory[axis].at(time_s);
  return result;
}

}  // namespace crane::control
