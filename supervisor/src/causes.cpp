#include "decisions.hpp"

namespace crane::supervisor {
namespace {

bool past_self_test(const Memory& m) { return m.state != State::boot && m.state != State::selftest; }

// ARMING waits for the bridge before it opens the brakes; from then on a bridge that has stopped is a cause.
bool bridge_matters(const Memory& m) { return m.state != State::arming || m.releasing; }

Cause power_off_cause(const Inputs& in, const Memory& m) {
  if (in.second_writer) return Cause::second_writer;
  if ((in.bridge_latched || in.watchdog_dropped) && bridge_matters(m)) return Cause::bridge_latched;
  if (in.not_homed && !m.homing) return Cause::not_homed;
  if (m.homing && m.state == State::run && in.homing_failure != HomingFailure::none)
    return Cause::homing_failed;
  if (in.envelope.position) return Cause::position_limit;
  if (in.envelope.limit_switch) return Cause::limit_switch;
  if (in.envelope.overspeed) return Cause::overspeed;
  if (drives_active(m) && !in.brakes_open) return Cause::brake_did_not_open;
  return Cause::none;
}

Cause ramped_stop_cause(const Limits& limits, const Inputs& in, const Memory& m) {
  if (in.state_stale) return Cause::state_stale;
  if (in.gate_cause != Cause::none) return in.gate_cause;
  if (in.overrun) return Cause::overrun;
  if (in.envelope.stopping) return Cause::stopping_envelope;
  if (in.envelope.swing_runaway) return Cause::swing_limit;
  if (m.state == State::stop_c1 && in.now_s - m.entered_s >= limits.stop_timeout_s)
    return Cause::stop_timeout;
  return Cause::none;
}

Cause controlled_stop_cause(const Limits& limits, const Inputs& in, const Memory& m) {
  if (in.envelope.swing) return Cause::swing_limit;
  if (asked(in, Request::stop)) return Cause::operator_stop;
  if (asked(in, Request::disarm)) return Cause::operator_disarm;
  if (m.homing && m.state == State::run && in.homed) return Cause::homed;
  if (m.state == State::hold && in.now_s - m.idle_since_s >= limits.idle_lock_s) return Cause::idle;
  return Cause::none;
}

// ARMING has its own tests: the demand has to match, the bridge to be ready, the brakes to open, the axes to
// stay.
Cause arming_cause(const Limits& limits, const Inputs& in, const Memory& m) {
  if (m.state != State::arming) return Cause::none;
  if (!m.releasing) {
    if (in.now_s - m.entered_s < limits.arm_match_time_s) return Cause::none;
    return in.bridge_latched || in.watchdog_dropped ? Cause::bridge_latched : Cause::demand_rate;
  }
  if (in.moved_while_arming) return Cause::stopping_envelope;
  const bool late = in.now_s - m.release_since_s >= limits.brake_test_time_s;
  return late && !in.brakes_open ? Cause::brake_did_not_open : Cause::none;
}

}  // namespace

Cause blocking_cause(const Inputs& in) noexcept {
  if (in.estop_pressed) return Cause::estop_input;
  if (in.second_writer) return Cause::second_writer;
  if (in.state_stale) return Cause::state_stale;
  if (in.envelope.position) return Cause::position_limit;
  if (in.envelope.limit_switch) return Cause::limit_switch;
  if (in.envelope.swing) return Cause::swing_limit;
  return Cause::none;
}

// From the severest group to the mildest: the first cause found is the worst one.
Finding worst_cause(const Limits& limits, const Inputs& in, const Memory& m) noexcept {
  if (in.brake_failed && past_self_test(m)) return {Cause::brake_did_not_close, Reaction::fault};
  if (m.state == State::selftest && in.self_test == SelfTest::failed)
    return {Cause::selftest_failed, Reaction::fault};
  if (in.estop_pressed) return {Cause::estop_input, Reaction::estop};
  if (asked(in, Request::estop)) return {Cause::operator_estop, Reaction::estop};
  if (!armed(m)) return {};
  if (const Cause c = power_off_cause(in, m); c != Cause::none) return {c, Reaction::power_off};
  if (const Cause c = arming_cause(limits, in, m); c != Cause::none) return {c, reaction_to(c)};
  if (const Cause c = ramped_stop_cause(limits, in, m); c != Cause::none) return {c, Reaction::ramped_stop};
  if (const Cause c = controlled_stop_cause(limits, in, m); c != Cause::none)
    return {c, Reaction::controlled_stop};
  return {};
}

}  // namespace crane::supervisor
