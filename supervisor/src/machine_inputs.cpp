#include "machine_inputs.hpp"

#include <algorithm>
#include <cmath>

namespace crane::supervisor {
namespace {

AxisFlags unknown_axes(const Limits& limits, const TickMemory& memory) {
  AxisFlags unknown{};
  for (std::size_t i = 0; i < kAxes; ++i)
    unknown[i] = limits.axis[i].present && (memory.sample.position_unknown[i] || is_homing(memory, i));
  return unknown;
}

AxisFlags doubtful_axes(const TickInput& input, const TickMemory& memory) {
  AxisFlags doubtful{};
  for (std::size_t i = 0; i < kAxes; ++i) doubtful[i] = memory.restart.doubtful[i] && !input.confirmed[i];
  return doubtful;
}

/// @return index of the first set flag; kAxes: none
std::size_t first_of(const AxisFlags& flags) {
  return static_cast<std::size_t>(std::ranges::find(flags, true) - flags.begin());
}

bool every_brake_open(const Limits& limits, const TickMemory& memory) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (brake_may_open(limits, memory, i) && memory.sample.brake_closed[i]) return false;
  }
  return true;
}

bool every_brake_closed(const Limits& limits, const TickMemory& memory) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (limits.axis[i].present && !memory.sample.brake_closed[i]) return false;
  }
  return true;
}

bool moved(const Limits& limits, const PerAxis& from, const PerAxis& to) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (limits.axis[i].present && std::abs(to[i] - from[i]) > limits.axis[i].brake_slip) return true;
  }
  return false;
}

}  // namespace

bool is_homing(const TickMemory& memory, std::size_t axis) {
  return memory.machine.homing && memory.homing_axis == axis;
}

bool brake_may_open(const Limits& limits, const TickMemory& memory, std::size_t axis) {
  return limits.axis[axis].present && (!memory.machine.homing || memory.homing_axis == axis);
}

EnvelopeInput envelope_input(const Limits& limits, const TickInput& input, const TickMemory& memory) {
  return {.position = memory.motion.position,
          .speed = memory.motion.speed,
          .swing_radial_rad = memory.sample.swing_radial_rad,
          .swing_tangential_rad = memory.sample.swing_tangential_rad,
          .limit_low = memory.sample.limit_low,
          .limit_high = memory.sample.limit_high,
          .speed_share = input.speed_share,
          .unknown = unknown_axes(limits, memory)};
}

Inputs machine_inputs(const Limits& limits, const TickInput& input, const Checks& checks,
                      const TickMemory& memory) {
  const Sample& sample = memory.sample;
  const std::size_t unhomed = first_of(unknown_axes(limits, memory));
  const std::size_t doubtful = first_of(doubtful_axes(input, memory));
  return {
      .now_s = input.now_s,
      .self_test = input.self_test,
      .state_stale = !memory.motion.started || memory.state_missing_in_row >= limits.state_stale_after_ticks,
      .demand_stale = checks.gated.stale,
      .gate_cause = checks.gated.cause,
      .measured = envelope_input(limits, input, memory),
      .envelope = checks.envelope,
      .following_error = checks.following_error,
      .swing_sensor_failed = checks.swing_sensor_failed,
      .zone_ahead = checks.zone.needs_controlled_stop,
      .zone_touched = checks.zone.needs_ramped_stop,
      .estop_pressed = sample.estop_pressed,
      .bridge_latched = sample.command_stale || sample.command_invalid,
      .watchdog_dropped = sample.watchdog_dropped,
      .second_writer = input.second_writer,
      .configuration_differs = input.configuration_differs,
      .foreign_command = input.foreign_command,
      .bridge_restarted = input.bridge_restarted,
      .position_doubtful = (doubtful < kAxes),
      .doubtful_axis = doubtful % kAxes,
      .swing_zero_doubtful = memory.restart.swing_zero_doubtful,
      .overrun = limits.overruns_in_row > 0 && memory.overruns_in_row >= limits.overruns_in_row,
      .brake_did_not_close = checks.brake_did_not_close || input.brake_open_without_command,
      .relay_did_not_open = checks.relay_did_not_open,
      .relay_closed = !memory.relay_permitted && !sample.watchdog_dropped,
      .moved_while_arming = memory.machine.state == State::arming && memory.machine.releasing &&
                            moved(limits, memory.release_position, memory.motion.position),
      .demand_near_zero = checks.gated.near_zero,
      .brakes_open = every_brake_open(limits, memory),
      .brakes_closed = every_brake_closed(limits, memory),
      .standstill = standstill(limits, input.now_s, memory.motion),
      .reference_moving = input.reference_moving,
      .not_homed = unhomed < kAxes,
      .unhomed_axis = unhomed % kAxes,
      .home_axis = input.home_axis,
      .can_home = limits.axis[input.home_axis].homes(),
      .homed = memory.machine.homing && memory.homing.phase == HomingPhase::done,
      .homing_failure = memory.machine.homing ? memory.homing.failure : HomingFailure::none,
      .requests = input.requests};
}

}  // namespace crane::supervisor
