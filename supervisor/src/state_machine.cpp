#include "crane/supervisor/state_machine.hpp"

#include "decisions.hpp"

namespace crane::supervisor {
namespace {

// Severity of the present state: only a reaction with a higher severity changes the state.
Reaction severity(const Memory& m) {
  switch (m.state) {
    case State::stop_c1:
      return m.ramping ? Reaction::ramped_stop : Reaction::controlled_stop;
    case State::locked:
    case State::stop_c0:
      return Reaction::power_off;
    case State::estop:
      return Reaction::estop;
    case State::fault:
      return Reaction::fault;
    default:
      return Reaction::none;
  }
}

void enter(State state, Cause cause, const Inputs& in, Memory& m) {
  m.state = state;
  m.cause = cause;
  m.entered_s = in.now_s;
}

void start_ramp(Memory& m) {
  m.ramping = true;
  m.ramp_tick = 0;
}

void react(Finding finding, const Inputs& in, Memory& m) {
  const bool was_arming = m.state == State::arming;
  switch (finding.reaction) {
    case Reaction::none:
      return;
    case Reaction::controlled_stop:
      enter(State::stop_c1, finding.cause, in, m);
      m.ramping = false;
      if (was_arming) start_ramp(m);  // the drives are not active yet: no motion to stop
      return;
    case Reaction::ramped_stop:
      enter(State::stop_c1, finding.cause, in, m);
      start_ramp(m);
      return;
    case Reaction::power_off:
      enter(State::stop_c0, finding.cause, in, m);
      break;
    case Reaction::estop:
      enter(State::estop, finding.cause, in, m);
      break;
    case Reaction::fault:
      enter(State::fault, finding.cause, in, m);
      break;
  }
  m.releasing = false;
}

bool accepted(const Answers& answers, Request request) {
  return answers[static_cast<std::size_t>(request)].accepted;
}

/// A passed self-test of the old bridge is not valid for a new bridge. ESTOP and FAULT do not change.
void restart_self_test(const Inputs& in, Memory& m) {
  m.self_test_passed = false;
  m.clear_since_s = m.fresh_since_s = in.now_s;
  if (m.state == State::estop || m.state == State::fault) return;
  enter(State::selftest, Cause::bridge_restarted, in, m);
  m.releasing = m.ramping = false;
}

void step_ready(const Limits& limits, const Inputs& in, const Answers& answers, Memory& m) {
  const Cause blocking = blocking_cause(limits, in, m);
  if (blocking != Cause::none) {
    enter(State::locked, blocking, in, m);
  } else if (requested(in, Request::stop) || requested(in, Request::disarm)) {
    const bool stop = requested(in, Request::stop);
    enter(State::locked, stop ? Cause::operator_stop : Cause::operator_disarm, in, m);
  } else if (accepted(answers, Request::arm)) {
    enter(State::arming, Cause::none, in, m);
    m.releasing = m.homing = false;
  } else if (accepted(answers, Request::home)) {
    enter(State::arming, Cause::none, in, m);
    m.releasing = false;
    m.homing = true;
  }
}

void step_arming(const Inputs& in, Memory& m) {
  if (!m.releasing) {
    if (!in.demand_near_zero || in.bridge_latched || in.watchdog_dropped) return;
    m.releasing = true;
    m.release_since_s = in.now_s;
  } else if (in.brakes_open) {
    enter(m.homing ? State::run : State::hold, Cause::none, in, m);
    m.idle_since_s = in.now_s;
  }
}

void step_armed(const Limits& limits, const Inputs& in, const Answers& answers, Memory& m) {
  if (m.homing) return;  // a cause ends homing: HOMED, HOMING_FAILED, or any other cause
  if (m.state == State::hold && (accepted(answers, Request::move) || in.reference_moving)) {
    enter(State::run, Cause::none, in, m);
    m.move_began = false;
  } else if (m.state == State::run && accepted(answers, Request::move)) {
    m.entered_s = in.now_s;
    m.move_began = false;
  }
  if (m.state != State::run) return;
  m.move_began = m.move_began || in.reference_moving;
  // For callers without OperatorRequests. In the process, OperatorRequests::is_moving() ends such a move
  // earlier, 0.2 s after its acceptance.
  const bool never_began = !m.move_began && in.now_s - m.entered_s >= limits.longest_wait_for_motion_s;
  if ((m.move_began && !in.reference_moving) || never_began) {
    enter(State::hold, Cause::none, in, m);
    m.idle_since_s = in.now_s;
  }
}

/// The request `stop` replaces a routine cause by OPERATOR_STOP, so that no program resets the stop by
/// itself.
void replace_routine_cause(const Inputs& in, Memory& m) {
  if (requested(in, Request::stop) && is_routine(m.cause)) m.cause = Cause::operator_stop;
}

void step_stop(const Limits& limits, const Inputs& in, Memory& m) {
  if (m.state == State::stop_c1 && !m.ramping && in.standstill) start_ramp(m);
  if (m.state == State::stop_c1 && m.ramping && m.ramp_tick < ramp_ticks(limits)) {
    ++m.ramp_tick;
    if (m.ramp_tick == ramp_ticks(limits)) m.releasing = false;
    return;
  }
  const bool braking = m.state == State::stop_c0 || m.ramping;
  if (braking && in.standstill && in.brakes_closed && !in.state_stale) enter(State::locked, m.cause, in, m);
}

void transition(const Limits& limits, const Inputs& in, const Answers& answers, Memory& m) {
  switch (m.state) {
    case State::boot:
      if (in.self_test != SelfTest::not_started) enter(State::selftest, Cause::start, in, m);
      break;
    case State::selftest:
      if (in.self_test != SelfTest::passed) break;
      m.self_test_passed = true;
      enter(State::locked, m.cause, in, m);
      break;
    case State::locked:
      replace_routine_cause(in, m);
      [[fallthrough]];
    case State::estop:
      if (!accepted(answers, Request::reset)) break;
      if (m.self_test_passed) {
        enter(State::ready, Cause::none, in, m);
      } else {
        enter(State::selftest, Cause::start, in, m);
      }
      break;
    case State::ready:
      step_ready(limits, in, answers, m);
      break;
    case State::arming:
      step_arming(in, m);
      break;
    case State::hold:
    case State::run:
      step_armed(limits, in, answers, m);
      break;
    case State::stop_c1:
    case State::stop_c0:
      replace_routine_cause(in, m);
      step_stop(limits, in, m);
      break;
    case State::fault:
      break;
  }
}

Outputs outputs_of(const Limits& limits, const Memory& m, const Answers& answers) {
  Outputs out{.state = m.state, .cause = m.cause, .answers = answers};
  const bool ramp = m.state == State::stop_c1 && m.ramping && m.ramp_tick < ramp_ticks(limits);
  if (drives_active(m)) out.volts = Volts::pass;
  if (ramp) {
    out.volts = Volts::ramp;
    out.ramp_factor = 1 - static_cast<double>(m.ramp_tick) / ramp_ticks(limits);
  }
  out.brake_release = m.releasing && in_armed_scope(m);
  out.homing = m.homing;
  out.watchdog_permission = m.state == State::ready || in_armed_scope(m);
  out.stop_motion = m.state != State::hold && m.state != State::run;
  return out;
}

}  // namespace

bool drives_active(const Memory& m) noexcept {
  return m.state == State::hold || m.state == State::run || (m.state == State::stop_c1 && !m.ramping);
}

Outputs step(const Limits& limits, const Inputs& in, Memory& m) noexcept {
  if (blocking_cause(limits, in, m) != Cause::none || m.state == State::boot) m.clear_since_s = in.now_s;
  if (in.state_stale || in.demand_stale || m.state == State::boot) m.fresh_since_s = in.now_s;

  if (in.bridge_restarted && protection::enabled("supervisor_bridge_restarted")) restart_self_test(in, m);
  const Finding finding = first_matching_cause(limits, in, m);
  if (finding.reaction > severity(m)) react(finding, in, m);
  const Answers answers = answer_all(limits, in, m);
  transition(limits, in, answers, m);
  m.homing = m.homing && in_armed_scope(m);
  m.reset_requested_before = requested(in, Request::reset);
  return outputs_of(limits, m, answers);
}

}  // namespace crane::supervisor
