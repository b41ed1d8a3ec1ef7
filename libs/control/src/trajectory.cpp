#include "crane/control/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "require.hpp"

namespace crane::control {
namespace {

void throw_on(const Requirements& rules) {
  if (rules.found.empty()) return;
  std::string text;
  for (const auto& problem : rules.found) text += (text.empty() ? "" : "; ") + problem;
  throw std::invalid_argument(text);
}

void require_finite(Requirements& rules, double start, double target) {
  rules.require(std::isfinite(start), "start", start, "must be finite");
  rules.require(std::isfinite(target), "target", target, "must be finite");
}

}  // namespace

AxisReference AxisProfile::at(double time_s) const noexcept {
  if (time_s < 0) return {start, 0, 0};
  const double remaining_s = duration_s() - time_s;
  if (remaining_s <= 0) return {target, 0, 0};
  if (time_s < ramp_s)
    return {start + acceleration * time_s * time_s / 2, acceleration * time_s, acceleration};
  if (remaining_s < ramp_s)
    return {target - acceleration * remaining_s * remaining_s / 2, acceleration * remaining_s, -acceleration};
  return {start + speed * (time_s - ramp_s / 2), speed, 0};
}

AxisProfile step_profile(double start, double target) noexcept { return {start, target, 0, 0, 0, 0}; }

AxisProfile limited_profile(double start, double target, const AxisLimits& limits) {
  Requirements rules;
  require_finite(rules, start, target);
  rules.require(limits.speed > 0 && std::isfinite(limits.speed), "speed", limits.speed, "must be > 0");
  rules.require(limits.acceleration > 0 && std::isfinite(limits.acceleration), "acceleration",
                limits.acceleration, "must be > 0");
  throw_on(rules);
  const double distance = std::abs(target - start);
  const double sign = target < start ? -1 : 1;
  const double ramp_at_limit_s = limits.speed / limits.acceleration;
  const bool triangle = distance < limits.speed * ramp_at_limit_s;
  const double ramp_s = triangle ? std::sqrt(distance / limits.acceleration) : ramp_at_limit_s;
  const double coast_s = triangle ? 0 : distance / limits.speed - ramp_at_limit_s;
  return {start, target, ramp_s, coast_s, sign * limits.acceleration * ramp_s, sign * limits.acceleration};
}

AxisProfile timed_profile(double start, double target, double final_time_s, double ramp_s) {
  Requirements rules;
  require_finite(rules, start, target);
  rules.require(ramp_s > 0, "ramp_s", ramp_s, "must be > 0");
  rules.require(std::isfinite(final_time_s) && final_time_s >= 2 * ramp_s, "final_time_s", final_time_s,
                "must be at least two ramps");
  throw_on(rules);
  const double speed = (target - start) / (final_time_s - ramp_s);
  return {start, target, ramp_s, final_time_s - 2 * ramp_s, speed, speed / ramp_s};
}

AxisProfile stretched(const AxisProfile& profile, double duration_s) noexcept {
  if (!(profile.duration_s() > 0) || duration_s <= profile.duration_s()) return profile;
  const double scale = duration_s / profile.duration_s();
  AxisProfile result = profile;
  result.ramp_s *= scale;
  result.coast_s *= scale;
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
