#include "crane/supervisor/supervisor.hpp"

#include <algorithm>
#include <cmath>

namespace crane::supervisor {
namespace {

constexpr int kCounterEnd = 1'000'000;  // counts in a row stop here: a stream may be missing for months

bool all_finite(const Sample& sample) {
  return std::ranges::all_of(sample.position, [](double x) { return std::isfinite(x); }) &&
         std::isfinite(sample.swing_radial_rad) && std::isfinite(sample.swing_tangential_rad);
}

// @return true when a usable sample has come in this tick
bool take_sample(const Limits& limits, const TickInput& input, TickMemory& memory) {
  if (!input.state_arrived || !all_finite(input.sample)) {
    memory.state_missing_in_row = std::min(memory.state_missing_in_row + 1, kCounterEnd);
    return false;
  }
  memory.state_missing_in_row = 0;
  const bool late = memory.motion.started && input.sample.overruns != memory.sample.overruns;
  memory.overruns_in_row = late ? std::min(memory.overruns_in_row + 1, kCounterEnd) : 0;
  memory.sample = input.sample;
  observe(limits, input.now_s, input.tick, input.sample.position, memory.motion);
  return true;
}

bool every_present_brake(const Limits& limits, const AxisFlags& brake_closed, bool closed) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (limits.axis[i].present && brake_closed[i] != closed) return false;
  }
  return true;
}

bool moved(const Limits& limits, const PerAxis& from, const PerAxis& to) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (limits.axis[i].present && std::abs(to[i] - from[i]) > limits.axis[i].brake_slip) return true;
  }
  return false;
}

Envelope envelope_now(const Limits& limits, const TickMemory& memory) {
  return check_envelope(limits, {.position = memory.motion.position,
                                 .speed = memory.motion.speed,
                                 .swing_radial_rad = memory.sample.swing_radial_rad,
                                 .swing_tangential_rad = memory.sample.swing_tangential_rad,
                                 .limit_low = memory.sample.limit_low,
                                 .limit_high = memory.sample.limit_high});
}

// Before the self-test has passed the brakes' anchor follows the axes.
bool watch_brakes(const Limits& limits, const TickInput& input, bool sampled, TickMemory& memory) {
  const State state = memory.machine.state;
  if (memory.machine.releasing || state == State::boot || state == State::selftest)
    memory.brakes.anchored = false;
  if (memory.machine.releasing || !sampled) return false;
  return brake_failed(limits, input.now_s, memory.motion, memory.sample.brake_closed, memory.brakes);
}

GateOutput run_gate(const Limits& limits, const TickInput& input, const Envelope& envelope,
                    TickMemory& memory) {
  const GateInput in{.arrived = input.demand_arrived,
                     .demand_v = input.demand_v,
                     .armed = drives_active(memory.machine),
                     .block_positive = envelope.block_positive,
                     .block_negative = envelope.block_negative};
  return gate(limits, in, memory.gate);
}

Inputs machine_inputs(const Limits& limits, const TickInput& input, const Envelope& envelope,
                      const GateOutput& gated, bool brakes_failed, const TickMemory& memory) {
  const Sample& sample = memory.sample;
  return {
      .now_s = input.now_s,
      .self_test = input.self_test,
      .state_stale = !memory.motion.started || memory.state_missing_in_row >= limits.state_stale_after_ticks,
      .demand_stale = gated.stale,
      .gate_cause = gated.cause,
      .envelope = envelope,
      .estop_pressed = sample.estop_pressed,
      .bridge_latched = sample.command_stale || sample.command_invalid,
      .watchdog_dropped = sample.watchdog_dropped,
      .second_writer = input.second_writer,
      .overrun = limits.overruns_in_row > 0 && memory.overruns_in_row >= limits.overruns_in_row,
      .brake_failed = brakes_failed,
      .moved_while_arming =
          memory.machine.releasing && moved(limits, memory.release_position, memory.motion.position),
      .demand_near_zero = gated.near_zero,
      .brakes_open = every_present_brake(limits, sample.brake_closed, false),
      .brakes_closed = every_present_brake(limits, sample.brake_closed, true),
      .standstill = standstill(limits, input.now_s, memory.motion),
      .reference_moving = input.reference_moving,
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
          .second_writer = in.second_writer};
}

}  // namespace

TickOutput step(const Limits& limits, const TickInput& input, TickMemory& memory) noexcept {
  const bool sampled = take_sample(limits, input, memory);
  const Envelope envelope = envelope_now(limits, memory);
  const bool brakes_failed = watch_brakes(limits, input, sampled, memory);
  const GateOutput gated = run_gate(limits, input, envelope, memory);
  const Inputs inputs = machine_inputs(limits, input, envelope, gated, brakes_failed, memory);

  const bool was_ramping = memory.machine.ramping && memory.machine.state == State::stop_c1;
  const bool was_releasing = memory.machine.releasing;
  const Outputs decided = step(limits, inputs, memory.machine);
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
  for (std::size_t i = 0; i < kAxes; ++i)
    out.brake_release[i] = decided.brake_release && limits.axis[i].present;
  memory.gate.last_v = out.drive_v;
  return out;
}

}  // namespace crane::supervisor
