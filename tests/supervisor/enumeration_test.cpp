// Rules that hold for every state and every combination of inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "crane/supervisor/rules.hpp"
#include "timeline.hpp"

namespace crane::supervisor {
namespace {

constexpr double kNow_s = 100;

// Every state with the parts of its memory that influence decisions. Armed states also occur while an axis is
// being homed.
std::vector<Memory> every_memory() {
  std::vector<Memory> all;
  for (std::size_t i = 0; i < kStates; ++i) {
    Memory m{.state = static_cast<State>(i), .cause = Cause::start, .entered_s = kNow_s - 0.5};
    m.idle_since_s = m.release_since_s = kNow_s - 0.05;
    m.self_test_passed = m.state != State::boot && m.state != State::selftest;
    m.releasing = m.state == State::hold || m.state == State::run;
    if (m.state == State::arming || m.state == State::stop_c1) {
      m.releasing = m.state == State::stop_c1;
      all.push_back(m);
      m.releasing = true;
      m.ramping = m.state == State::stop_c1;
      all.push_back(m);
      m.ramp_tick = m.ramping ? 2 : 0;
      m.releasing = !m.ramping;
    }
    all.push_back(m);
    if (m.state == State::estop || m.state == State::locked) {
      m.self_test_passed = false;
      all.push_back(m);
    }
  }
  for (std::size_t i = 0, n = all.size(); i < n; ++i) {
    if (all[i].state != State::arming && all[i].state != State::run && all[i].state != State::stop_c1)
      continue;
    all.push_back(all[i]);
    all.back().homing = true;
  }
  return all;
}

constexpr unsigned kFaults = 12;
void set_faults(unsigned bits, Inputs& in) {
  const auto bit = [bits](unsigned i) { return (bits >> i & 1U) != 0; };
  in.state_stale = bit(0);
  in.envelope.stopping = bit(1);
  in.envelope.position = bit(2);
  in.envelope.limit_switch = bit(3);
  in.envelope.overspeed = bit(4);
  in.envelope.swing = bit(5);
  in.envelope.swing_runaway = bit(5) && bit(6);
  in.bridge_latched = bit(7);
  in.watchdog_dropped = bit(7) && !bit(6);
  in.not_homed = bit(6);
  in.second_writer = bit(8);
  in.overrun = bit(9);
  in.bridge_restarted = bit(9) && bit(4);
  in.position_doubtful = bit(9) && bit(1);
  in.swing_zero_doubtful = bit(9) && bit(2);
  in.brake_did_not_close = bit(10);
  in.relay_did_not_open = bit(10) && bit(0);
  in.relay_closed = bit(10) && bit(1);
  in.estop_pressed = bit(11);
}

constexpr unsigned kObservations = 6;
void set_observations(unsigned bits, Inputs& in) {
  const auto bit = [bits](unsigned i) { return (bits >> i & 1U) != 0; };
  in.demand_near_zero = bit(0);
  in.brakes_open = bit(1);
  in.brakes_closed = !bit(1) && bit(2);
  in.standstill = bit(3);
  in.reference_moving = bit(4);
  in.moved_while_arming = bit(5);
  in.homed = bit(5) && bit(0);
  if (bit(5) && bit(3)) in.homing_failure = HomingFailure::no_motion;
}

void set_requests(unsigned bits, Inputs& in) {
  for (std::size_t i = 0; i < kRequests; ++i) in.requests[i] = (bits >> i & 1U) != 0;
}

constexpr Cause kGateCauses[] = {Cause::none, Cause::demand_stale, Cause::demand_invalid, Cause::demand_rate};

bool may_release(const Memory& after) {
  return after.state == State::arming || after.state == State::hold || after.state == State::run ||
         after.state == State::stop_c1;
}

bool stopped(State s) {
  return s == State::locked || s == State::stop_c1 || s == State::stop_c0 || s == State::estop ||
         s == State::fault;
}

// An accepted request takes effect in the same tick.
const char* broken_promise(const Memory& before, const Inputs& in, const Memory& after, const Outputs& out) {
  const auto accepted = [&out](Request request) { return out.answers[index_of(request)].accepted; };
  const State is = after.state;
  if (accepted(Request::reset) && is != State::selftest && before.state != State::ready &&
      is != State::ready) {
    return "an accepted reset leads to READY or SELFTEST";
  }
  if (accepted(Request::reset) && before.state != State::ready &&
      (in.position_doubtful || in.swing_zero_doubtful))
    return "nothing is reset while a position or the swing zero is doubtful";
  if (accepted(Request::arm) && is != State::arming) return "an accepted arm leads to ARMING";
  if (accepted(Request::home) && !(is == State::arming && after.homing))
    return "an accepted homing leads to ARMING for it";
  if (accepted(Request::arm) && after.homing) return "arming is not homing";
  if (accepted(Request::move) && is != State::run) return "an accepted move leads to RUN";
  const bool stop = in.requests[index_of(Request::stop)] || in.requests[index_of(Request::disarm)];
  if (stop && (is == State::arming || is == State::hold || is == State::run)) return "a stop stops";
  return nullptr;
}

// @return the name of a broken rule, or null
const char* broken_rule(const Memory& before, const Inputs& in, const Memory& after, const Outputs& out) {
  const State was = before.state;
  const State is = after.state;
  const bool reset = in.requests[index_of(Request::reset)];
  const bool estop = in.estop_pressed || in.requests[index_of(Request::estop)];
  if (out.state != is || out.cause != after.cause) return "outputs say what the memory says";
  if (out.brake_release && !may_release(after)) return "brakes open only in ARMING, HOLD, RUN and STOP_C1";
  if (out.brake_release && !before.releasing && was != State::arming) return "only ARMING opens the brakes";
  const bool moving = is == State::hold || is == State::run || is == State::stop_c1;
  if (out.volts != Volts::zero && !moving) return "volts only in HOLD, RUN and STOP_C1";
  if (out.volts == Volts::pass && !out.brake_release) return "no demand against a closed brake";
  if (!(out.ramp_factor >= 0 && out.ramp_factor < 1)) return "the ramp falls";
  if (out.watchdog_permission && (is < State::ready || is >= State::stop_c0))
    return "relay off where all is off";
  if (was == State::fault && is != State::fault) return "FAULT ends by a restart only";
  if (estop && is != State::estop && is != State::fault) return "ESTOP wins";
  if (is == State::fault && was != State::fault && !in.brake_did_not_close && !in.relay_did_not_open &&
      in.self_test != SelfTest::failed) {
    return "FAULT has three causes";
  }
  if (in.bridge_restarted && is != State::selftest && is != State::locked && is != State::estop &&
      is != State::fault)
    return "a new bridge is tested first";
  if (in.bridge_restarted && in.self_test != SelfTest::passed && after.self_test_passed)
    return "a new bridge is not the one that was tested";
  if (in.bridge_restarted && is == State::selftest) return nullptr;
  if (stopped(was) && !stopped(is) && !(reset && (was == State::locked || was == State::estop))) {
    return "only a reset leads out of a stop";
  }
  if (was == State::estop && is != State::estop && is != State::fault && !reset) return "ESTOP needs a reset";
  const bool at_rest = in.standstill && !in.state_stale;
  if ((was == State::stop_c0 || was == State::stop_c1) && is == State::locked && !in.bridge_restarted &&
      !(at_rest && in.brakes_closed)) {
    return "a stop ends at a standstill that is seen, with the brakes closed";
  }
  if (was == State::estop && is == State::ready && !at_rest) return "ESTOP ends at a standstill that is seen";
  if (was == State::stop_c0 && is == State::stop_c1) return "severity falls";
  if (was == State::stop_c1 && is == State::stop_c1 && before.ramping && !after.ramping)
    return "severity falls";
  if (is == State::arming && was != State::arming && was != State::ready) return "arming begins in READY";
  if (is == State::arming && was == State::ready && !in.requests[index_of(Request::arm)] &&
      !in.requests[index_of(Request::home)])
    return "arming is asked for";
  if (after.homing && !before.homing && !in.requests[index_of(Request::home)]) return "homing is asked for";
  if (after.homing && is == State::hold) return "homing never holds";
  if (in.not_homed && !after.homing && may_release(after) && is != State::stop_c1)
    return "without a zero nothing but homing opens a brake";
  if (is == State::hold && was != State::hold && was != State::run && was != State::arming)
    return "HOLD after ARMING";
  const bool after_hold = was == State::hold || was == State::run || (was == State::arming && before.homing);
  if (is == State::run && !after_hold) return "RUN after HOLD, or to home";
  if (is == State::ready && was != State::ready && !after.self_test_passed) return "self-test first";
  if (stopped(is) && out.cause == Cause::none && was != is) return "a stop has a cause";
  return broken_promise(before, in, after, out);
}

class Enumeration : public ::testing::Test {
 protected:
  void check(const Memory& before, const Inputs& in) {
    Memory after = before;
    const Outputs out = step(limits_, in, after);
    const char* rule = broken_rule(before, in, after, out);
    if (rule != nullptr)
      FAIL() << rule << ": " << name_of(before.state) << " -> " << name_of(after.state) << " "
             << name_of(after.cause);
  }
  const Limits limits_ = test_limits();
  const std::vector<Memory> memories_ = every_memory();
};

TEST_F(Enumeration, EveryStateAgainstEveryFaultAndObservationKeepsTheRules) {  // S15
  for (const Memory& before : memories_) {
    for (unsigned faults = 0; faults < 1U << kFaults; ++faults) {
      for (unsigned observations = 0; observations < 1U << kObservations; ++observations) {
        Inputs in{.now_s = kNow_s, .self_test = SelfTest::passed};
        set_faults(faults, in);
        set_observations(observations, in);
        in.gate_cause = kGateCauses[(faults + observations) % 4];
        in.demand_stale = in.gate_cause == Cause::demand_stale;
        check(before, in);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_F(Enumeration, EveryStateAgainstEveryFaultAndRequestKeepsTheRules) {  // S15
  for (const Memory& before : memories_) {
    for (unsigned faults = 0; faults < 1U << kFaults; ++faults) {
      for (unsigned requests = 0; requests < 1U << kRequests; ++requests) {
        Inputs in{.now_s = kNow_s, .self_test = SelfTest::passed};
        set_faults(faults, in);
        set_requests(requests, in);
        check(before, in);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_F(Enumeration, EveryStateAgainstEveryRequestSelfTestAndGateCauseKeepsTheRules) {  // S15
  for (const Memory& before : memories_) {
    for (unsigned requests = 0; requests < 1U << kRequests; ++requests) {
      for (unsigned observations = 0; observations < 1U << kObservations; ++observations) {
        for (unsigned rest = 0; rest < 16; ++rest) {
          Inputs in{.now_s = kNow_s,
                    .self_test = static_cast<SelfTest>(rest % 4),
                    .gate_cause = kGateCauses[rest / 4]};
          set_requests(requests, in);
          set_observations(observations, in);
          check(before, in);
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

}  // namespace
}  // namespace crane::supervisor
