#include "process/samples.hpp"

#include <algorithm>

#include "crane/runtime/convert.hpp"

namespace crane::supervisor {
namespace {

/// The enumerators of the logic have the numbers of crane.idl.
template <class Logic, class Idl>
constexpr bool same(Logic logic, Idl idl) {
  return static_cast<int>(logic) == static_cast<int>(idl);
}
static_assert(same(State::boot, crane_STATE_BOOT));
static_assert(same(State::selftest, crane_STATE_SELFTEST));
static_assert(same(State::locked, crane_STATE_LOCKED));
static_assert(same(State::ready, crane_STATE_READY));
static_assert(same(State::arming, crane_STATE_ARMING));
static_assert(same(State::hold, crane_STATE_HOLD));
static_assert(same(State::run, crane_STATE_RUN));
static_assert(same(State::stop_c1, crane_STATE_STOP_C1));
static_assert(same(State::stop_c0, crane_STATE_STOP_C0));
static_assert(same(State::estop, crane_STATE_ESTOP));
static_assert(same(State::fault, crane_STATE_FAULT));
// the enumerators are generated from crane.idl
static_assert(same(Cause::configuration_differs, crane_CAUSE_CONFIGURATION_DIFFERS));
static_assert(same(HomingFailure::mark_not_found, crane_HOMING_MARK_NOT_FOUND));
static_assert(same(HomingFailure::mark_stuck, crane_HOMING_MARK_STUCK));
static_assert(same(HomingFailure::other_switch, crane_HOMING_OTHER_SWITCH));
static_assert(same(HomingFailure::no_motion, crane_HOMING_NO_MOTION));
static_assert(same(HomingFailure::mark_disagrees, crane_HOMING_MARK_DISAGREES));

}  // namespace

Sample sample_of(const msg::State& state) {
  Sample sample;
  sample.time_s = static_cast<double>(state.header.sample_time_ns) / 1e9;
  sample.position = {state.trolley_position_m, state.slew_angle_rad, state.cable_length_m};
  sample.swing_radial_rad = state.swing_radial_rad;
  sample.swing_tangential_rad = state.swing_tangential_rad;
  for (std::size_t i = 0; i < kAxes; ++i) {
    sample.brake_closed[i] = state.brake_closed[i];
    sample.limit_low[i] = state.limit_low[i];
    sample.limit_high[i] = state.limit_high[i];
    sample.position_unknown[i] = !state.position_known[i];
    sample.mark_active[i] = state.mark_active[i];
    sample.mark_found[i] = state.mark_found[i];
  }
  sample.applied_v = runtime::values(state.applied_v);
  sample.estop_pressed = state.estop_pressed;
  sample.command_stale = state.command_stale;
  sample.command_invalid = state.command_invalid;
  sample.watchdog_dropped = state.watchdog_dropped;
  sample.overruns = state.overruns;
  return sample;
}

msg::Command command_of(const msg::Header& header, const TickOutput& output) {
  msg::Command command{};
  command.header = header;
  runtime::assign(command.drive_v, output.drive_v);
  for (std::size_t i = 0; i < kAxes; ++i) {
    command.brake_release[i] = output.brake_release[i];
    command.homing[i] = output.homing[i];
  }
  command.watchdog_permission = output.watchdog_permission;
  return command;
}

msg::AcceptedMove accepted_move(const msg::Request& request, std::uint64_t number) {
  msg::AcceptedMove move{};
  move.number = number;
  move.request_id = request.id;
  std::ranges::copy(request.client, move.client);
  move.kind = request.kind;
  std::ranges::copy(request.selected, move.selected);
  runtime::assign(move.target, runtime::values(request.target));
  std::ranges::copy(request.sine, move.sine);
  move.duration_s = request.duration_s;
  return move;
}

msg::SupervisorStatus status_of(const msg::Header& header, const TickOutput& output, const Limits& limits,
                                const msg::AcceptedMove& move, const PerAxis& jog_deflection, Mode mode) {
  msg::SupervisorStatus status{};
  status.header = header;
  status.state = static_cast<crane_SupervisorState>(output.state);
  status.cause = static_cast<crane_Cause>(output.cause);
  status.state_stale = output.flags.state_stale;
  status.demand_stale = output.flags.demand_stale;
  status.demand_invalid = output.flags.demand_invalid;
  status.demand_clamped = output.flags.demand_clamped;
  status.envelope_violated = output.flags.envelope_violated;
  status.swing_exceeded = output.flags.swing_exceeded;
  status.bridge_latched = output.flags.bridge_latched;
  status.estop_active = output.flags.estop_active;
  status.second_writer = output.flags.second_writer;
  status.configuration_differs = output.flags.configuration_differs;
  for (std::size_t i = 0; i < kAxes; ++i) {
    status.low_limit[i] = limits.axis[i].low_limit;
    status.high_limit[i] = limits.axis[i].high_limit;
    status.volt_limit_v[i] = limits.axis[i].volt_limit_v;
    status.homing[i] = output.homing[i];
  }
  status.clamped_count = output.clamped_count;
  status.rejected_count = output.rejected_count;
  status.missing_demand_count = output.missing_demand_count;
  status.move = move;
  runtime::assign(status.homing_speed, output.homing_speed);
  runtime::assign(status.jog_deflection, jog_deflection);
  status.mode = static_cast<crane_OperatingMode>(mode);
  status.homing_failure = static_cast<crane_HomingFailure>(output.homing_failure);
  return status;
}

}  // namespace crane::supervisor
