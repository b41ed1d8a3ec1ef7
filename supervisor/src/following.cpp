#include "crane/supervisor/following.hpp"

#include <algorithm>
#include <cmath>

#include "crane/plant/equations.hpp"

namespace crane::supervisor {
namespace {

// Consecutive samples with an open brake before the check starts: three samples, and the two voltages before
// them.
constexpr int kSettled_ticks = 5;

/// Accelerations, unit/s^2.
struct Interval {
  double low, high;
};

void remember(const FollowingInput& input, FollowingMemory& memory) noexcept {
  memory.recent[2] = memory.recent[1];
  memory.recent[1] = memory.recent[0];
  memory.recent[0] = {input.sampled_s, input.position, input.swing_radial_rad, input.swing_tangential_rad,
                      input.applied_v};
  for (std::size_t i = 0; i < kAxes; ++i)
    memory.free_ticks[i] = input.free[i] ? std::min(memory.free_ticks[i] + 1, kSettled_ticks) : 0;
}

/// State at the middle one of the last three samples. The rates are means over both intervals.
plant::State state_of(const Limits& limits, const FollowingMemory& memory) noexcept {
  const auto& [newest, middle, oldest] = memory.recent;
  const double span_s = newest.sampled_s - oldest.sampled_s;
  const auto rate = [span_s](double now, double before) { return (now - before) / span_s; };
  plant::State s;
  s.trolley_m = middle.position[0];
  s.slew_rad = middle.position[1];
  s.cable_m = limits.machine.cable(middle.position[2]);
  s.radial_rad = middle.radial_rad;
  s.tangential_rad = middle.tangential_rad;
  s.trolley_mps = rate(newest.position[0], oldest.position[0]);
  s.slew_radps = rate(newest.position[1], oldest.position[1]);
  s.cable_mps = rate(newest.position[2], oldest.position[2]);
  s.radial_radps = rate(newest.radial_rad, oldest.radial_rad);
  s.tangential_radps = rate(newest.tangential_rad, oldest.tangential_rad);
  return s;
}

/// Acceleration of each axis under the mean voltage of the last two ticks, without friction, unit/s^2. The
/// voltages are weighted by the durations of their ticks, which differ after a pause of the computer.
PerAxis accelerations(const Limits& limits, const FollowingMemory& memory, const plant::State& state,
                      double load_kg) noexcept {
  plant::Parameters p = limits.machine.crane;
  p.load_mass_kg = load_kg;
  const auto &newest = memory.recent[0], &middle = memory.recent[1], &oldest = memory.recent[2];
  const double newer = (newest.sampled_s - middle.sampled_s) / (newest.sampled_s - oldest.sampled_s);
  const auto mean_v = [&, newer](std::size_t i) {
    return newer * middle.applied_v[i] + (1 - newer) * oldest.applied_v[i];
  };
  plant::Locks locks;
  for (std::size_t i = 0; i < kAxes; ++i) locks.axis[i] = memory.free_ticks[i] < kSettled_ticks;
  locks.radial = !limits.machine.swing_measured[0];
  locks.tangential = !limits.machine.swing_measured[1];
  const plant::Forces forces{.trolley_n = p.trolley_inertia_kg * p.trolley_gain_mps2pv * mean_v(0),
                             .slew_nm = p.jib_inertia_kgm2 * p.slew_gain_radps2pv * mean_v(1)};
  const double cable_mps2 = (p.hoist_gain_mpspv * mean_v(2) - state.cable_mps) / p.hoist_lag_s;
  const auto found = plant::accelerations(p, state, forces, cable_mps2, locks);
  return {found.trolley_mps2, found.slew_radps2, found.cable_mps2};
}

/// Acceleration of an axis without the force of the load, unit/s^2 per V.
double gain_of(const Limits& limits, std::size_t axis, const plant::State& state) noexcept {
  const auto& p = limits.machine.crane;
  if (axis == 0) return p.trolley_gain_mps2pv;
  if (axis == 2) return p.hoist_gain_mpspv / p.hoist_lag_s;
  const double jib = p.jib_inertia_kgm2;
  return p.slew_gain_radps2pv * jib / (jib + p.trolley_mass_kg * state.trolley_m * state.trolley_m);
}

/// Largest acceleration of an axis by a load whose swing is not measured, unit/s^2: the load is
/// assumed at the swing limit.
double unmeasured_load_acceleration(const Limits& limits, std::size_t axis,
                                    const plant::State& state) noexcept {
  if (axis == 2 || limits.machine.swing_measured[axis]) return 0;
  const auto& p = limits.machine.crane;
  const double force_n = kLoadRatioMax * p.load_mass_kg * p.gravity_mps2 * std::sin(limits.swing_limit_rad);
  return axis == 0 ? force_n / p.trolley_inertia_kg
                   : force_n * std::abs(state.trolley_m) / p.jib_inertia_kgm2;
}

/// Largest friction of one direction of motion, V.
double friction_v(const MachineModel::Friction& friction, double speed) noexcept {
  return kFrictionRatioMax * (friction.rest_v + friction.viscous_vs_per_unit * std::abs(speed)) +
         kFrictionExtra_v;
}

/// Motion of one axis over the last three samples.
struct AxisMotion {
  std::size_t axis;
  double dt_s;           ///< time between the middles of both intervals
  double speed, before;  ///< between the two newest samples, and between the two oldest, unit/s
  double largest_v;      ///< largest absolute voltage of the last two ticks
};

AxisMotion motion_of(std::size_t axis, const FollowingMemory& memory) noexcept {
  const auto& [newest, middle, oldest] = memory.recent;
  const double newer_s = newest.sampled_s - middle.sampled_s, older_s = middle.sampled_s - oldest.sampled_s;
  return {.axis = axis,
          .dt_s = (newer_s + older_s) / 2,
          .speed = (newest.position[axis] - middle.position[axis]) / newer_s,
          .before = (middle.position[axis] - oldest.position[axis]) / older_s,
          .largest_v = std::max(std::abs(middle.applied_v[axis]), std::abs(oldest.applied_v[axis]))};
}

/// Accelerations that the model permits between the oldest and the newest sample.
/// @param of_loads  accelerations of the model without friction, for all load masses
Interval permitted(const Limits& limits, const AxisMotion& motion, const plant::State& state,
                   const Interval& of_loads) noexcept {
  const std::size_t i = motion.axis;
  const double gain = gain_of(limits, i, state);
  const double drag = i == 2 ? std::abs(motion.speed) / limits.machine.crane.hoist_lag_s : 0;
  const double unknown = gain * (kGainTolerance * motion.largest_v + kOffset_v) + kGainTolerance * drag +
                         unmeasured_load_acceleration(limits, i, state);
  Interval found{of_loads.low - unknown, of_loads.high + unknown};
  // below this speed the friction can have either sign
  const double zero_speed = kSpeedShare * limits.axis[i].max_speed;
  if (std::max(motion.speed, motion.before) > -zero_speed)
    found.low -= gain * friction_v(limits.machine.friction_positive[i], motion.before);
  if (std::min(motion.speed, motion.before) < zero_speed)
    found.high += gain * friction_v(limits.machine.friction_negative[i], motion.before);
  return found;
}

/// Adds the change of speed outside the interval to the sums. @return true when a sum exceeds its limit
bool judge_axis(const Limits& limits, const AxisMotion& motion, const Interval& interval,
                FollowingMemory& memory) noexcept {
  const std::size_t i = motion.axis;
  const double dt_s = motion.dt_s, dv = motion.speed - motion.before;
  memory.above[i] = std::max(0.0, memory.above[i] + dv - interval.high * dt_s);
  memory.below[i] = std::max(0.0, memory.below[i] + interval.low * dt_s - dv);
  const double ratio =
      std::max(memory.above[i], memory.below[i]) / following_limit(limits, i, motion.before, dt_s);
  memory.largest[i] = std::max(memory.largest[i], ratio);
  return !(ratio <= 1);
}

}  // namespace

double following_limit(const Limits& limits, std::size_t axis, double speed, double span_s) noexcept {
  return kSpeedShare * (limits.axis[axis].max_speed + std::abs(speed)) +
         2 * limits.machine.resolution[axis] / span_s;
}

bool following_error(const Limits& limits, const FollowingInput& input, FollowingMemory& memory) noexcept {
  if (!limits.machine.known || !(input.sampled_s > memory.recent[0].sampled_s)) return false;
  remember(input, memory);
  const bool any_free =
      std::ranges::any_of(memory.free_ticks, [](int ticks) { return ticks == kSettled_ticks; });
  if (!any_free) {
    memory.above = memory.below = {};
    return false;
  }
  const auto state = state_of(limits, memory);
  const auto with_load =
      accelerations(limits, memory, state, kLoadRatioMax * limits.machine.crane.load_mass_kg);
  const auto without_load = accelerations(limits, memory, state, 0);
  bool found = false;
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!limits.axis[i].present || memory.free_ticks[i] != kSettled_ticks) {
      memory.above[i] = memory.below[i] = 0;
      continue;
    }
    const AxisMotion motion = motion_of(i, memory);
    const Interval of_loads{std::min(with_load[i], without_load[i]), std::max(with_load[i], without_load[i])};
    found = judge_axis(limits, motion, permitted(limits, motion, state, of_loads), memory) || found;
  }
  return found;
}

}  // namespace crane::supervisor
