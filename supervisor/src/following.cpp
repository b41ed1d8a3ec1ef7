#include "crane/supervisor/following.hpp"

#include <algorithm>
#include <cmath>

#include "crane/plant/equations.hpp"

namespace crane::supervisor {
namespace {

constexpr int kSettled_ticks = 5;  // both voltages and all three samples are of an open brake
constexpr double kFrictionReserve = 1.5;
constexpr double kStepReserve = 1.3;  // of a step that a controller overshoots by
constexpr double kStepForget_s = 10;
constexpr double kSwingForget_s = 5;
constexpr double kSwingReserve = 1.5;  // of the load's way, that an anti-swing law moves the axis by
constexpr double kLeastReach_m = 0.3;

void remember(const FollowingInput& input, FollowingMemory& memory) noexcept {
  memory.seen[2] = memory.seen[1];
  memory.seen[1] = memory.seen[0];
  memory.seen[0] = {input.sampled_s, input.position, input.swing_radial_rad, input.swing_tangential_rad,
                    input.applied_v};
  for (std::size_t i = 0; i < kAxes; ++i)
    memory.free_ticks[i] = input.free[i] ? std::min(memory.free_ticks[i] + 1, kSettled_ticks) : 0;
}

/// The middle sample with the mean rates around it.
plant::State state_of(const Limits& limits, const FollowingMemory& memory) noexcept {
  const auto& [newest, middle, oldest] = memory.seen;
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

/// What the mean voltage of the last two ticks makes of each axis without friction. @param load_kg 0: no load
PerAxis accelerations(const Limits& limits, const FollowingMemory& memory, const plant::State& state,
                      double load_kg) noexcept {
  plant::Parameters p = limits.machine.crane;
  p.load_mass_kg = load_kg;
  const auto mean_v = [&](std::size_t i) {
    return (memory.seen[1].applied_v[i] + memory.seen[2].applied_v[i]) / 2;
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

/// Acceleration per volt of an axis whose load hangs loose.
double gain_of(const Limits& limits, std::size_t axis, const plant::State& state) noexcept {
  const auto& p = limits.machine.crane;
  if (axis == 0) return p.trolley_gain_mps2pv;
  if (axis == 2) return p.hoist_gain_mpspv / p.hoist_lag_s;
  const double jib = p.jib_inertia_kgm2;
  return p.slew_gain_radps2pv * jib / (jib + p.trolley_mass_kg * state.trolley_m * state.trolley_m);
}

/// Change of speed that nothing explains, unit/s, signed.
double unexplained(const Limits& limits, std::size_t i, const FollowingMemory& memory,
                   const plant::State& state, double with_load, double without_load) noexcept {
  const auto& [newest, middle, oldest] = memory.seen;
  const double newer_s = newest.sampled_s - middle.sampled_s, older_s = middle.sampled_s - oldest.sampled_s;
  const double v = (newest.position[i] - middle.position[i]) / newer_s;
  const double before = (middle.position[i] - oldest.position[i]) / older_s;
  const double dt_s = (newer_s + older_s) / 2;
  const double gain = gain_of(limits, i, state);
  const double volts_v = std::max(std::abs(middle.applied_v[i]), std::abs(oldest.applied_v[i]));
  const double drag = i == 2 ? std::abs(v) / limits.machine.crane.hoist_lag_s : 0;
  const double unknown =
      gain * (kGainUnknown * volts_v + kOffset_v) + kGainUnknown * drag + std::abs(with_load - without_load);
  const double friction = kFrictionReserve * gain *
                          (limits.machine.friction_v[i] + limits.machine.viscous_v[i] * std::abs(before));
  const double slow = kSpeedShare * limits.axis[i].max_speed;  // either way at these speeds
  double low = with_load - unknown, high = with_load + unknown;
  if (std::max(v, before) > -slow) low -= friction;
  if (std::min(v, before) < slow) high += friction;
  const double change = v - before;
  const double excess = change - std::clamp(change, low * dt_s, high * dt_s);
  const double noise = 4 * limits.machine.resolution[i] / dt_s;  // two counts in each of two differences
  return std::copysign(std::max(std::abs(excess) - noise, 0.0), excess);
}

void note(double error, double limit, std::size_t axis, FollowingMemory& memory, Following& found) noexcept {
  const double ratio = error / limit;
  memory.largest[axis] = std::max(memory.largest[axis], ratio);
  found.once = found.once || !(ratio <= 1);
  found.twice = found.twice || !(ratio <= 2);
}

void judge_speed(const Limits& limits, FollowingMemory& memory, Following& found) noexcept {
  const auto state = state_of(limits, memory);
  const auto with_load = accelerations(limits, memory, state, limits.machine.crane.load_mass_kg);
  const auto without = accelerations(limits, memory, state, 0);
  const double keep = 1 - limits.period_s / kForget_s;
  const PerAxis speed{state.trolley_mps, state.slew_radps, state.cable_mps};
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!limits.axis[i].present || memory.free_ticks[i] < kSettled_ticks) {
      memory.speed_error[i] = 0;
      continue;
    }
    memory.speed_error[i] =
        keep * memory.speed_error[i] + unexplained(limits, i, memory, state, with_load[i], without[i]);
    const double limit = kSpeedShare * (limits.axis[i].max_speed + std::abs(speed[i]));
    note(std::abs(memory.speed_error[i]), limit, i, memory, found);
  }
}

/// How far the load may make an anti-swing law move the axis.
double swing_way(const Limits& limits, std::size_t axis, const FollowingMemory& memory) noexcept {
  const auto& position = memory.seen[0].position;
  const double way_m = kSwingReserve * limits.machine.cable(position[2]) * memory.swing_rad;
  return axis == 0 ? way_m : axis == 1 ? way_m / std::max(position[0], kLeastReach_m) : 0;
}

void judge_reference(const Limits& limits, const FollowingInput& input, FollowingMemory& memory,
                     Following& found) noexcept {
  const double swing_rad = std::hypot(input.swing_radial_rad, input.swing_tangential_rad);
  memory.swing_rad = std::max(swing_rad, memory.swing_rad * (1 - limits.period_s / kSwingForget_s));
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!input.reference_arrived) return;
    const AxisLimits& axis = limits.axis[i];
    const double error = std::abs(input.position[i] - input.reference[i]);
    const double jump = std::abs(input.reference[i] - memory.last_reference[i]);
    const bool steps = !memory.referenced || jump > 2 * axis.max_speed * limits.period_s;
    memory.step_left[i] = steps ? std::max(kStepReserve * error, memory.step_left[i])
                                : memory.step_left[i] * (1 - limits.period_s / kStepForget_s);
    memory.last_reference[i] = input.reference[i];
    if (!axis.present || memory.free_ticks[i] < kSettled_ticks) continue;
    const double limit = kTravelShare * (axis.high_limit - axis.low_limit) + memory.step_left[i] +
                         kReferenceLag_s * std::abs(input.reference_speed[i]) + swing_way(limits, i, memory);
    note(error, limit, i, memory, found);
  }
  memory.referenced = true;
}

}  // namespace

Following judge_following(const Limits& limits, const FollowingInput& input,
                          FollowingMemory& memory) noexcept {
  Following found;
  if (!limits.machine.known || !(input.sampled_s > memory.seen[0].sampled_s)) return found;
  remember(input, memory);
  const bool any_free =
      std::ranges::any_of(memory.free_ticks, [](int ticks) { return ticks == kSettled_ticks; });
  if (any_free) judge_speed(limits, memory, found);
  judge_reference(limits, input, memory, found);
  return found;
}

}  // namespace crane::supervisor
