#include "decisions.hpp"

namespace crane::supervisor {
namespace {

using enum protection::Protection;
using protection::enabled;

constexpr std::array<const char*, kAxes> kNotHomed{
    "the position of the trolley is not known: reset, then `crane home --axis trolley`",
    "the position of the slewing jib is not known: reset, then `crane home --axis slew`",
    "the position of the hoist is not known: reset, then `crane home --axis hoist`"};

constexpr std::array<const char*, kAxes> kNoMark{
    "the trolley has no homing mark: set zero = \"homing\" in [encoder.trolley] of the rig file and add "
    "[homing.trolley]",
    "the slewing jib has no homing mark: set zero = \"homing\" in [encoder.slew] of the rig file and add "
    "[homing.slew]",
    "the hoist has no homing mark: set zero = \"homing\" in [encoder.hoist] of the rig file and add "
    "[homing.hoist]"};

constexpr std::array<const char*, kAxes> kDoubtful{
    "the trolley was moving or at another position when the bridge ended: check that it is where `crane "
    "status` shows it, then `crane reset --confirm-positions`",
    "the slewing jib was moving or at another position when the bridge ended: check that it is where `crane "
    "status` shows it, then `crane reset --confirm-positions`",
    "the hoist was moving or at another position when the bridge ended: check that it is where `crane "
    "status` shows it, then `crane reset --confirm-positions`"};

Answer refuse(const char* reason) { return {.requested = true, .accepted = false, .reason = reason}; }
constexpr Answer kAccepted{.requested = true, .accepted = true, .reason = ""};

Answer answer_reset(const Limits& limits, const Inputs& in, const Memory& m) {
  switch (m.state) {
    case State::ready:
      return kAccepted;
    case State::locked:
    case State::estop:
      break;
    case State::boot:
    case State::selftest:
      return refuse("the self-test is not finished: wait for LOCKED");
    case State::stop_c1:
    case State::stop_c0:
      return refuse("the crane is still stopping: wait for LOCKED");
    case State::fault:
      return refuse("a reset does not end FAULT: remove the cause, then restart the supervisor");
    default:
      return refuse("the crane is armed: there is nothing to reset");
  }
  if (requested(in, Request::estop))
    return refuse("an emergency stop was requested in the same tick: reset again");
  if (m.reset_requested_before && enabled(reset_edge))
    return refuse("a reset was also requested in the previous tick: request the reset again");
  if (const Cause c = blocking_cause(limits, in, m); c != Cause::none) return refuse(remedy_for(c));
  if (in.relay_closed) return refuse("the watchdog relay has not opened yet: wait, then reset");
  if (in.swing_zero_doubtful && enabled(reset_swing_zero_doubtful))
    return refuse(
        "the load swung when the bridge started: the zero of the swing encoders may be wrong; let the load "
        "hang at rest, then restart the bridge");
  if (in.position_doubtful && enabled(reset_position_doubtful)) return refuse(kDoubtful[in.doubtful_axis]);
  if (m.state == State::estop && !in.standstill) return refuse("the crane is still moving: wait, then reset");
  if (in.now_s - m.clear_since_s < limits.clear_time_s && enabled(reset_clear_time)) {
    return refuse("the last cause ended less than a second ago: wait, then reset again");
  }
  return kAccepted;
}

/// Common conditions of arming and homing, which both open brakes.
Answer answer_release(const Limits& limits, const Inputs& in, const Memory& m) {
  switch (m.state) {
    case State::ready:
      break;
    case State::arming:
    case State::hold:
    case State::run:
      return refuse("the crane is armed already");
    default:
      return refuse("the crane is not READY: reset first");
  }
  if (const Cause c = blocking_cause(limits, in, m); c != Cause::none) return refuse(remedy_for(c));
  if (requested(in, Request::stop) || requested(in, Request::disarm)) {
    return refuse("a stop was requested in the same tick: reset, then arm again");
  }
  if (in.gate_cause == Cause::demand_invalid) return refuse(remedy_for(Cause::demand_invalid));
  if (in.demand_stale) return refuse(remedy_for(Cause::demand_stale));
  if (in.now_s - m.fresh_since_s < limits.fresh_time_s && enabled(arm_fresh_time)) {
    return refuse("state and demand have been fresh for less than a second: wait, then arm again");
  }
  return kAccepted;
}

Answer answer_arm(const Limits& limits, const Inputs& in, const Memory& m) {
  const Answer answer = answer_release(limits, in, m);
  return answer.accepted && in.not_homed ? refuse(kNotHomed[in.unhomed_axis]) : answer;
}

Answer answer_home(const Limits& limits, const Inputs& in, const Memory& m) {
  if (!in.can_home) return refuse(kNoMark[in.home_axis]);
  if (m.homing) return refuse("an axis is being homed: wait for LOCKED");
  if (m.state == State::arming || m.state == State::hold || m.state == State::run)
    return refuse("the crane is armed: disarm and reset it first");
  if (m.state == State::ready && requested(in, Request::arm))
    return refuse("arming was requested in the same tick: home again");
  return answer_release(limits, in, m);
}

Answer answer_move(const Inputs& in, const Memory& m) {
  if (m.homing) return refuse("an axis is being homed: wait for LOCKED, then reset and arm");
  if (in.not_homed) return refuse(kNotHomed[in.unhomed_axis]);
  if (m.state == State::hold || m.state == State::run) return kAccepted;
  if (m.state == State::arming) return refuse("the brakes are being tested: wait for HOLD");
  if (m.state == State::ready) return refuse("the crane is not armed: arm it first");
  return refuse("the crane is stopped: reset and arm it first");
}

}  // namespace

Answers answer_all(const Limits& limits, const Inputs& in, const Memory& m) noexcept {
  Answers answers;
  const auto put = [&](Request request, const Answer& answer) {
    if (requested(in, request)) answers[static_cast<std::size_t>(request)] = answer;
  };
  put(Request::reset, answer_reset(limits, in, m));
  put(Request::arm, answer_arm(limits, in, m));
  put(Request::move, answer_move(in, m));
  put(Request::home, answer_home(limits, in, m));
  put(Request::disarm, kAccepted);
  put(Request::stop, kAccepted);
  put(Request::estop, kAccepted);
  return answers;
}

}  // namespace crane::supervisor
