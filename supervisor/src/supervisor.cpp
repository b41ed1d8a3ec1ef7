#include "crane/supervisor/supervisor.hpp"

#include <algorithm>
#include <cmath>

#include "crane/protection.hpp"
#include "machine_inputs.hpp"
#include "taken_sample.hpp"

namespace crane::supervisor {
namespace {

/// Advances homing by one tick. @return speed of the reference, unit/s; 0 outside homing
double advance_homing(const Limits& limits, TickMemory& memory) {
  if (!memory.machine.homing || memory.machine.state != State::run) return 0;
  const std::size_t i = memory.homing_axis;
  const Sample& sample = memory.sample;
  const auto mark = limits.axis[i].homing.mark;
  return step_homing(limits, i,
                     {.position = memory.motion.position[i],
                      .mark_active = sample.mark_active[i],
                      .mark_found = sample.mark_found[i],
                      .other_switch = (mark != control::Mark::limit_low && sample.limit_low[i]) ||
                                      (mark != control::Mark::limit_high && sample.limit_high[i])},
                     memory.homing);
}

/// @return true when a brake that is commanded closed does not hold its axis, or does not report
///   closed in time. In BOOT and SELFTEST, every tick restarts the check.
bool watch_brakes(const Limits& limits, const TickInput& input, bool sampled, TickMemory& memory) {
  const State state = memory.machine.state;
  if (memory.machine.releasing || state == State::boot || state == State::selftest)
    memory.brakes.valid = false;
  if (memory.machine.releasing || !sampled) return false;
  return brake_did_not_close(limits, input.now_s, memory.motion, memory.sample.brake_closed, memory.brakes);
}

bool watch_relay(const Limits& limits, const TickInput& input, bool sampled, TickMemory& memory) {
  const State state = memory.machine.state;
  if (memory.relay_permitted || state == State::boot || state == State::selftest) memory.relay = {};
  if (memory.relay_permitted || !sampled) return false;
  return relay_did_not_open(limits, input.now_s, !memory.sample.watchdog_dropped, memory.relay);
}

/// During homing, the other axes get 0 V, and the voltage of the homed axis is limited to volt_limit_v of its
/// homing.
PerAxis homing_limited_demand(const Limits& limits, const TickInput& input, const TickMemory& memory) {
  PerAxis demand_v = input.demand_v;
  if (!memory.machine.homing || !std::ranges::all_of(demand_v, [](double v) { return std::isfinite(v); }))
    return demand_v;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double most_v = is_homing(memory, i) ? limits.axis[i].homing.volt_limit_v : 0;
    demand_v[i] = std::clamp(demand_v[i], -most_v, most_v);
  }
  return demand_v;
}

GateOutput run_gate(const Limits& limits, const TickInput& input, const Envelope& envelope,
                    TickMemory& memory) {
  const GateInput in{.arrived = input.demand_arrived,
                     .demand_v = homing_limited_demand(limits, input, memory),
                     .drives_active = drives_active(memory.machine),
                     .block_positive = envelope.block_positive,
                     .block_negative = envelope.block_negative};
  return gate(limits, in, memory.gate);
}

/// Not checked during homing, because the position is unknown; step_homing() checks the motion.
bool check_following_error(const Limits& limits, bool sampled, TickMemory& memory) {
  if (!sampled) return false;
  AxisFlags free{};
  for (std::size_t i = 0; i < kAxes; ++i)
    free[i] = memory.machine.releasing && !memory.machine.homing && !memory.sample.brake_closed[i];
  const bool found = following_error(limits, following_input(memory.sample, free), memory.following);
  return found && drives_active(memory.machine);
}

bool check_swing_encoders(const Limits& limits, bool sampled, TickMemory& memory) {
  if (!sampled) return false;
  const bool failed = swing_sensor_failed(limits, pendulum_input(memory.sample), memory.pendulum);
  return failed && drives_active(memory.machine) && !memory.machine.homing;
}

/// Whether the bridge may set the zero of the homed axis: during homing, and after it has found and left its
/// mark, until the position is known. After any other stop, the bridge forgets the mark.
bool may_set_zero(const Outputs& decided, const TickMemory& memory) {
  if (memory.machine.homing) return true;
  return memory.may_set_zero && decided.state == State::locked && decided.cause == Cause::homed &&
         memory.sample.position_unknown[memory.homing_axis];
}

/// The zones have no effect during homing, because the position is unknown. A demand that could lead into a
/// zone is replaced by 0 V, from which the ramped stop starts.
ZoneVerdict guard_zones(const Limits& limits, bool sampled, GateOutput& gated, TickMemory& memory) {
  const ZoneInput in = zone_input(memory, gated.drive_v);
  if (sampled) observe_load(limits, in, memory.zones);
  if (!memory.machine.releasing || memory.machine.homing) {
    memory.zones.watching = false;
    return {};
  }
  const ZoneVerdict verdict = filter_zones(limits, in, memory.zones);
  if (verdict.needs_ramped_stop && protection::enabled("supervisor_zone")) gated.drive_v = {};
  return verdict;
}

PerAxis drive_volts(const Outputs& decided, const GateOutput& gated, bool ramp_begins, TickMemory& memory) {
  if (ramp_begins) memory.ramp_from_v = gated.drive_v;
  if (decided.volts == Volts::zero) return {};
  if (decided.volts == Volts::pass) return gated.drive_v;
  PerAxis drive_v{};
  for (std::size_t i = 0; i < kAxes; ++i) drive_v[i] = memory.ramp_from_v[i] * decided.ramp_factor;
  return drive_v;
}

StatusFlags flags_of(const Inputs& in, const GateOutput& gated, State state) {
  return {.state_stale = in.state_stale,
          .demand_stale = gated.stale,
          .demand_invalid = gated.invalid,
          .demand_clamped = gated.clamped,
          .envelope_violated = in.envelope.stopping || in.envelope.position || in.envelope.limit_switch ||
                               in.envelope.overspeed,
          .swing_exceeded = in.envelope.swing,
          .bridge_latched = in.bridge_latched || in.watchdog_dropped,
          .estop_active = in.estop_pressed || state == State::estop,
          .second_writer = in.second_writer,
          .configuration_differs = in.configuration_differs};
}

}  // namespace

TickOutput step(const Limits& limits, const TickInput& input, TickMemory& memory) noexcept {
  take_over_bridge(limits, input, memory);
  const bool sampled = take_sample(limits, input, memory);
  const Envelope envelope = check_envelope(limits, envelope_input(limits, input, memory));
  const bool brake_did_not_close = watch_brakes(limits, input, sampled, memory);
  const bool relay_did_not_open = watch_relay(limits, input, sampled, memory);
  GateOutput gated = run_gate(limits, input, envelope, memory);
  const ZoneVerdict zone = guard_zones(limits, sampled, gated, memory);
  const double homing_speed = advance_homing(limits, memory);
  const bool following_error = check_following_error(limits, sampled, memory);
  const bool swing_sensor_failed = check_swing_encoders(limits, sampled, memory);
  const Inputs inputs = machine_inputs(limits, input,
                                       {.envelope = envelope,
                                        .gated = gated,
                                        .zone = zone,
                                        .brake_did_not_close = brake_did_not_close,
                                        .relay_did_not_open = relay_did_not_open,
                                        .following_error = following_error,
                                        .swing_sensor_failed = swing_sensor_failed},
                                       memory);

  const bool was_ramping = memory.machine.ramping && memory.machine.state == State::stop_c1;
  const bool was_releasing = memory.machine.releasing;
  const Outputs decided = step(limits, inputs, memory.machine);
  if (decided.answers[static_cast<std::size_t>(Request::home)].accepted) {
    memory.homing = {};
    memory.homing_axis = input.home_axis;
  }
  if (decided.answers[static_cast<std::size_t>(Request::reset)].accepted) memory.restart.doubtful = {};
  if (decided.state == State::ready) memory.restart.watching = false;
  if (decided.brake_release && !was_releasing) memory.release_position = memory.motion.position;

  TickOutput out{.state = decided.state,
                 .cause = decided.cause,
                 .flags = flags_of(inputs, gated, decided.state),
                 .drive_v = drive_volts(decided, gated, !was_ramping, memory),
                 .watchdog_permission = decided.watchdog_permission,
                 .stop_motion = decided.stop_motion,
                 .answers = decided.answers,
                 .clamped_count = memory.gate.clamped_count,
                 .rejected_count = memory.gate.rejected_count,
                 .missing_demand_count = memory.gate.missing_count};
  out.homing_failure = memory.homing.failure;
  out.zone = zone.zone;
  memory.may_set_zero = may_set_zero(decided, memory);
  for (std::size_t i = 0; i < kAxes; ++i) {
    out.brake_release[i] = decided.brake_release && brake_may_open(limits, memory, i);
    out.homing[i] = memory.may_set_zero && memory.homing_axis == i;
    if (out.homing[i] && decided.state == State::run) out.homing_speed[i] = homing_speed;
  }
  memory.gate.last_v = out.drive_v;
  memory.relay_permitted = out.watchdog_permission;
  return out;
}

}  // namespace crane::supervisor
