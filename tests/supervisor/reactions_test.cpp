// The causes of docs/safety.md and their reactions while the crane runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>

#include "crane/supervisor/rules.hpp"
#include "timeline.hpp"

namespace crane::supervisor {
namespace {

struct Expectation {
  const char* name;
  void (*set)(Inputs&);
  Cause cause;
  Reaction reaction = Reaction::none;  ///< none: that of the only rule of the cause
};

Reaction reaction_of(const Expectation& row) {
  if (row.reaction != Reaction::none) return row.reaction;
  return std::ranges::find_if(rules(), [&](const Rule& rule) { return rule.cause == row.cause; })->reaction;
}

// The table of docs/safety.md, one row per cause that a signal can raise in RUN.
TEST(Reactions, EachSignalInRunHasTheCauseAndReactionOfTheTable) {  // S16
  const Expectation rows[] = {
      {"stop", [](Inputs& in) { in.requests[index_of(Request::stop)] = true; }, Cause::operator_stop},
      {"disarm", [](Inputs& in) { in.requests[index_of(Request::disarm)] = true; }, Cause::operator_disarm},
      {"estop request", [](Inputs& in) { in.requests[index_of(Request::estop)] = true; },
       Cause::operator_estop},
      {"estop input", [](Inputs& in) { in.estop_pressed = true; }, Cause::estop_input},
      {"state stale", [](Inputs& in) { in.state_stale = true; }, Cause::state_stale},
      {"demand stale", [](Inputs& in) { in.gate_cause = Cause::demand_stale; }, Cause::demand_stale},
      {"demand invalid", [](Inputs& in) { in.gate_cause = Cause::demand_invalid; }, Cause::demand_invalid},
      {"demand rate", [](Inputs& in) { in.gate_cause = Cause::demand_rate; }, Cause::demand_rate},
      {"bridge", [](Inputs& in) { in.bridge_latched = true; }, Cause::bridge_latched},
      {"relay", [](Inputs& in) { in.watchdog_dropped = true; }, Cause::bridge_latched},
      {"position", [](Inputs& in) { in.envelope.position = true; }, Cause::position_limit},
      {"stopping", [](Inputs& in) { in.envelope.stopping = true; }, Cause::stopping_envelope},
      {"limit switch", [](Inputs& in) { in.envelope.limit_switch = true; }, Cause::limit_switch},
      {"overspeed", [](Inputs& in) { in.envelope.overspeed = true; }, Cause::overspeed},
      {"swing", [](Inputs& in) { in.envelope.swing = true; }, Cause::swing_limit, Reaction::controlled_stop},
      {"swing runaway", [](Inputs& in) { in.envelope.swing = in.envelope.swing_runaway = true; },
       Cause::swing_limit, Reaction::ramped_stop},
      {"following", [](Inputs& in) { in.following_error = true; }, Cause::following_error,
       Reaction::power_off},
      {"foreign command", [](Inputs& in) { in.foreign_command = true; }, Cause::second_writer,
       Reaction::fault},
      {"swing sensor", [](Inputs& in) { in.swing_sensor_failed = true; }, Cause::swing_sensor},
      {"zone ahead", [](Inputs& in) { in.zone_ahead = true; }, Cause::zone, Reaction::controlled_stop},
      {"zone", [](Inputs& in) { in.zone_ahead = in.zone_touched = true; }, Cause::zone,
       Reaction::ramped_stop},
      {"brake", [](Inputs& in) { in.brakes_open = false; }, Cause::brake_did_not_open},
      {"relay welded", [](Inputs& in) { in.relay_did_not_open = true; }, Cause::relay_did_not_open},
      {"brake failed", [](Inputs& in) { in.brake_did_not_close = true; }, Cause::brake_did_not_close},
      {"second writer", [](Inputs& in) { in.second_writer = true; }, Cause::second_writer,
       Reaction::power_off},
      {"configuration", [](Inputs& in) { in.configuration_differs = true; }, Cause::configuration_differs},
      {"not homed", [](Inputs& in) { in.not_homed = true; }, Cause::not_homed},
      {"overrun", [](Inputs& in) { in.overrun = true; }, Cause::overrun}};
  for (const Expectation& row : rows) {
    Memory m{.state = State::run, .cause = Cause::none, .releasing = true, .move_began = true};
    Inputs in{.now_s = 1,
              .self_test = SelfTest::passed,
              .brakes_open = true,
              .brakes_closed = false,
              .reference_moving = true};
    Memory healthy = m;
    ASSERT_EQ(step(test_limits(), in, healthy).state, State::run);
    row.set(in);
    const Outputs out = step(test_limits(), in, m);
    EXPECT_EQ(out.cause, row.cause) << row.name;
    switch (reaction_of(row)) {
      case Reaction::controlled_stop:
        EXPECT_EQ(out.state, State::stop_c1) << row.name;
        EXPECT_EQ(out.volts, Volts::pass) << row.name;
        break;
      case Reaction::ramped_stop:
        EXPECT_EQ(out.state, State::stop_c1) << row.name;
        EXPECT_EQ(out.ramp_factor, 0.5) << row.name;
        break;
      case Reaction::power_off:
        EXPECT_EQ(out.state, State::stop_c0) << row.name;
        break;
      case Reaction::estop:
        EXPECT_EQ(out.state, State::estop) << row.name;
        break;
      case Reaction::fault:
        EXPECT_EQ(out.state, State::fault) << row.name;
        break;
      case Reaction::none:
        ADD_FAILURE() << row.name;
    }
  }
}

/// The table of docs/safety.md shows these texts; their figures are those of the limits.
TEST(Rules, StateTheFiguresOfTheLimits) {  // S16
  const Limits limits;
  const auto text = [](double value, const char* unit) {
    std::ostringstream number;
    number << value << ' ' << unit;
    return number.str();
  };
  const std::tuple<std::string_view, std::string, const char * Rule::*> figures[] = {
      {"supervisor_bridge_not_ready", text(limits.arm_match_time_s, "s"), &Rule::predicate},
      {"supervisor_bridge_not_ready", text(limits.arm_match_time_s, "s"), &Rule::detection},
      {"supervisor_no_match", text(limits.arm_match_time_s, "s"), &Rule::predicate},
      {"supervisor_no_match", text(limits.arm_volt_limit_v, "V"), &Rule::predicate},
      {"supervisor_no_match", text(limits.arm_match_time_s, "s"), &Rule::detection},
      {"supervisor_brake_did_not_open", text(limits.brake_test_time_s, "s"), &Rule::predicate},
      {"supervisor_brake_did_not_open", text(limits.brake_test_time_s, "s"), &Rule::detection},
      {"supervisor_stop_timeout", text(limits.stop_timeout_s, "s"), &Rule::predicate},
      {"supervisor_stop_timeout", text(limits.stop_timeout_s, "s"), &Rule::detection}};
  for (const auto& [name, figure, stated] : figures) {
    const auto rule = std::ranges::find(rules(), name, &Rule::name);
    ASSERT_NE(rule, rules().end()) << name;
    EXPECT_NE(std::string_view{(*rule).*stated}.find(figure), std::string_view::npos)
        << name << " states \"" << (*rule).*stated << "\", the limit is " << figure;
  }
}

}  // namespace
}  // namespace crane::supervisor
