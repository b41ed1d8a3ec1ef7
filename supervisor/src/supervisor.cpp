#include "crane/supervisor/supervisor.hpp"

#include <algorithm>
#include <cmath>

#include "crane/protection.hpp"

namespace crane::supervisor {
namespace {

// largest value of the counters, which would overflow if a stream were missing for months
constexpr int kCounterEnd = 1'000'000;

bool all_finite(const Sample& sample) {
  return std::isfinite(sample.time_s) &&
         std::ranges::all_of(sample.position, [](double x) { return std::isfinite(x); }) &&
         std::isfinite(sample.swing_radial_rad) && std::isfinite(sample.swing_tangential_rad);
}

/// All earlier samples are those of the old bridge.
void take_over_bridge(const Limits& limits, const TickInput& input, TickMemory& memory) {
  if (!input.bridge_restarted) return;
  AxisFlags known{};
  for (std::size_t i = 0; i < kAxes; ++i) known[i] = !memory.sample.position_unknown[i];
  const bool usable = input.state_arrived && all_finite(input.sample);
  take_over(limits, input.now_s, memory.motion, known, usable ? &input.sample.position : nullptr,
            memory.restart);
  memory.motion = {};
  memory.brakes = {};
  memory.relay = {};
  memory.following = {};
  memory.pendulum = {};
  memory.zones = {};
  memory.sample = {};
  memory.overruns_in_row = 0;
}

/// @return true when a usable sample has arrived in this tick
bool take_sample(const Limits& limits, const TickInput& input, TickMemory& memory) {
  if (!input.state_arrived || !all_finite(input.sample)) {
    memory.state_missing_in_row = std::min(memory.state_missing_in_row + 1, kCounterEnd);
    return false;
  }
  memory.state_missing_in_row = 0;
  const bool late = memory.motion.started && input.sample.overruns != memory.sample.overruns;
  memory.overruns_in_row = late ? std::min(memory.overruns_in_row + 1, kCounterEnd) : 0;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (memory.motion.started && memory.sample.position_unknown[i] && !input.sample.position_unknown[i])
      set_homed_position(i, input.sample.position[i], memory.motion, memory.brakes);
  memory.sample = input.sample;
  observe(limits, input.now_s, input.sample.time_s, input.sample.position, memory.motion);
  for (std::size_t i = 0; i < kAxes; ++i)  // homing ends the doubt about a position
    if (memory.sample.position_unknown[i]) memory.restart.doubted[i] = false;
  watch_load(limits, input.now_s, memory.sample.swing_radial_rad, memory.sample.swing_tangential_rad,
             memory.restart);
  return true;
}

bool is_homing(const TickMemory& memory, std::size_t axis) {
  return memory.machine.homing && memory.homing_axis == axis;
}

/// True when the brake of the axis opens. Brakes of all other axes stay closed.
bool takes_part(const Limits& limits, const TickMemory& memory, std::size_t axis) {
  return limits.axis[axis].present && (!memory.machine.homing || memory.homing_axis == axis);
}

AxisFlags unknown_axes(const Limits& limits, const TickMemory& memory) {
  AxisFlags unknown{};
  for (std::size_t i = 0; i < kAxes; ++i)
    unknown[i] = limits.axis[i].present && (memory.sample.position_unknown[i] || is_homing(memory, i));
  return unknown;
}

AxisFlags unclear_axes(const TickInput& input, const TickMemory& memory) {
  AxisFlags unclear{};
  for (std::size_t i = 0; i < kAxes; ++i) unclear[i] = memory.restart.doubted[i] && !input.confirmed[i];
  return unclear;
}

/// @return index of the first set flag; kAxes: none
std::size_t first_of(const AxisFlags& flags) {
  return static_cast<std::size_t>(std::ranges::find(flags, true) - flags.begin());
}

bool every_brake_open(const Limits& limits, const TickMemory& memory) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (takes_part(limits, memory, i) && memory.sample.brake_closed[i]) return false;
  }
  return true;
}

bool every_brake_closed(const Limits& limits, const TickMemory& memory) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (limits.axis[i].present && !memory.sample.brake_closed[i]) return false;
  }
  return true;
}

/// Advances homing by one tick while an axis is homed. @return speed of the reference, unit/s
double creep(const Limits& limits, TickMemory& memory) {
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

bool moved(const Limits& limits, const PerAxis& from, const PerAxis& to) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (limits.axis[i].present && std::abs(to[i] - from[i]) > limits.axis[i].brake_slip) return true;
  }
  return false;
}

EnvelopeInput measured_now(const Limits& limits, const TickInput& input, const TickMemory& memory) {
  return {.position = memory.motion.position,
          .speed = memory.motion.speed,
          .swing_radial_rad = memory.sample.swing_radial_rad,
          .swing_tangential_rad = memory.sample.swing_tangential_rad,
          .limit_low = memory.sample.limit_low,
          .limit_high = memory.sample.limit_high,
          .speed_share = input.speed_share,
          .unknown = unknown_axes(limits, memory)};
}

/// Until the self-test has passed, the position that the closed brakes must hold is set again in every tick.
bool watch_brakes(const Limits& limits, const TickInput& input, bool sampled, TickMemory& memory) {
  const State state = memory.machine.state;
  if (memory.machine.releasing || state == State::boot || state == State::selftest)
    memory.brakes.valid = false;
  if (memory.machine.releasing || !sampled) return false;
  return brake_failed(limits, input.now_s, memory.motion, memory.sample.brake_closed, memory.brakes);
}

bool watch_relay(const Limits& limits, const TickInput& input, bool sampled, TickMemory& memory) {
  const State state = memory.machine.state;
  if (memory.relay_permitted || state == State::boot || state == State::selftest) memory.relay = {};
  if (memory.relay_permitted || !sampled) return false;
  return relay_failed(limits, input.now_s, !memory.sample.watchdog_dropped, memory.relay);
}

/// While an axis is homed, the other axes get 0 V, and the voltage of the homed axis is limited to
/// volt_limit_v of its homing.
PerAxis demand_of(const Limits& limits, const TickInput& input, const TickMemory& memory) {
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
                     .demand_v = demand_of(limits, input, memory),
                     .armed = drives_active(memory.machine),
                     .block_positive = envelope.block_positive,
                     .block_negative = envelope.block_negative};
  return gate(limits, in, memory.gate);
}

/// The homed axis has no known position and is excluded; step_homing() checks its motion.
bool following_error_now(const Limits& limits, bool sampled, TickMemory& memory) {
  if (!sampled) return false;
  AxisFlags free{};
  for (std::size_t i = 0; i < kAxes; ++i)
    free[i] = memory.machine.releasing && !memory.machine.homing && !memory.sample.brake_closed[i];
  const bool found = following_error(limits, following_input(memory.sample, free), memory.following);
  return found && drives_active(memory.machine);
}

bool swing_sensor_now(const Limits& limits, bool sampled, TickMemory& memory) {
  if (!sampled) return false;
  const bool failed = swing_sensor_failed(limits, pendulum_input(memory.sample), memory.pendulum);
  return failed && drives_active(memory.machine) && !memory.machine.homing;
}

/// While an axis is homed, its position is unknown and the zones have no effect. A demand that could lead
/// into a zone is replaced by 0 V, from which the ramped stop starts.
ZoneVerdict guard_zones(const Limits& limits, bool sampled, GateOutput& gated, TickMemory& memory) {
  const ZoneInput in = zone_input(memory, gated.drive_v);
  if (sampled) observe_load(limits, in, memory.zones);
  if (!memory.machine.releasing || memory.machine.homing) {
    memory.zones.watching = false;
    return {};
  }
  const ZoneVerdict verdict = filter_zones(limits, in, memory.zones);
  if (verdict.touched && protection::enabled("supervisor_zone")) gated.drive_v = {};
  return verdict;
}

Inputs machine_inputs(const Limits& limits, const TickInput& input, const Envelope& envelope,
                      const GateOutput& gated, bool brakes_failed, bool relay_stuck,
                      const TickMemory& memory) {
  const Sample& sample = memory.sample;
  const std::size_t unhomed = first_of(unknown_axes(limits, memory));
  const std::size_t unclear = first_of(unclear_axes(input, memory));
  return {
      .now_s = input.now_s,
      .self_test = input.self_test,
      .state_stale = !memory.motion.started || memory.state_missing_in_row >= limits.state_stale_after_ticks,
      .demand_stale = gated.stale,
      .gate_cause = gated.cause,
      .measured = measured_now(limits, input, memory),
      .envelope = envelope,
      .estop_pressed = sample.estop_pressed,
      .bridge_latched = sample.command_stale || sample.command_invalid,
      .watchdog_dropped = sample.watchdog_dropped,
      .second_writer = input.second_writer,
      .configuration_differs = input.configuration_differs,
      .foreign_command = input.foreign_command,
      .bridge_restarted = input.bridge_restarted,
      .position_doubtful = (unclear < kAxes),
      .doubtful_axis = unclear % kAxes,
      .swing_zero_doubtful = memory.restart.swing_zero_doubtful,
      .overrun = limits.overruns_in_row > 0 && memory.overruns_in_row >= limits.overruns_in_row,
      .brake_failed = brakes_failed || input.brake_open_without_command,
      .relay_failed = relay_stuck,
      .relay_closed = !memory.relay_permitted && !sample.watchdog_dropped,
      .moved_while_arming =
          memory.machine.releasing && moved(limits, memory.release_position, memory.motion.position),
      .demand_near_zero = gated.near_zero,
      .brakes_open = every_brake_open(limits, memory),
      .brakes_closed = every_brake_closed(limits, memory),
      .standstill = standstill(limits, input.now_s, memory.motion),
      .reference_moving = input.reference_moving,
      .not_homed = unhomed < kAxes,
      .unhomed_axis = unhomed % kAxes,
      .can_home = limits.axis[input.home_axis].homes(),
      .homed = memory.machine.homing && memory.homing.phase == HomingPhase::done,
      .homing_failure = memory.machine.homing ? memory.homing.failure : HomingFailure::none,
      .requests = input.requests};
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
  const Envelope envelope = check_envelope(limits, measured_now(limits, input, memory));
  const bool brakes_failed = watch_brakes(limits, input, sampled, memory);
  const bool relay_stuck = watch_relay(limits, input, sampled, memory);
  GateOutput gated = run_gate(limits, input, envelope, memory);
  const ZoneVerdict zone = guard_zones(limits, sampled, gated, memory);
  const double creeping_speed = creep(limits, memory);
  Inputs inputs = machine_inputs(limits, input, envelope, gated, brakes_failed, relay_stuck, memory);
  inputs.following_error = following_error_now(limits, sampled, memory);
  inputs.swing_sensor_failed = swing_sensor_now(limits, sampled, memory);
  inputs.zone_ahead = zone.ahead;
  inputs.zone_touched = zone.touched;

  const bool was_ramping = memory.machine.ramping && memory.machine.state == State::stop_c1;
  const bool was_releasing = memory.machine.releasing;
  const Outputs decided = step(limits, inputs, memory.machine);
  if (decided.answers[static_cast<std::size_t>(Request::home)].accepted) {
    memory.homing = {};
    memory.homing_axis = input.home_axis;
  }
  if (decided.answers[static_cast<std::size_t>(Request::reset)].accepted) memory.restart.doubted = {};
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
  for (std::size_t i = 0; i < kAxes; ++i) {
    out.brake_release[i] = decided.brake_release && takes_part(limits, memory, i);
    out.homing[i] = is_homing(memory, i);
    if (out.homing[i] && decided.state == State::run) out.homing_speed[i] = creeping_speed;
  }
  memory.gate.last_v = out.drive_v;
  memory.relay_permitted = out.watchdog_permission;
  return out;
}

}  // namespace crane::supervisor
