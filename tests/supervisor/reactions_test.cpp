// The causes of docs/safety.md and their reactions while the crane runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>

#include "crane/supervisor/gate.hpp"
#include "crane/supervisor/rules.hpp"
#include "timeline.hpp"

namespace crane::supervisor {
namespace {

struct Expectation {
  const char* name;
  void (*set)(Inputs&);
  Cause cause;
  Reaction reaction;
};

// The table of docs/safety.md, one row per cause that a signal can raise in RUN.
TEST(Reactions, EachSignalInRunHasTheCauseAndReactionOfTheTable) {  // S16
  const Expectation rows[] = {
      {"stop", [](Inputs& in) { in.requests[index_of(Request::stop)] = true; }, Cause::operator_stop,
       Reaction::controlled_stop},
      {"disarm", [](Inputs& in) { in.requests[index_of(Request::disarm)] = true; }, Cause::operator_disarm,
       Reaction::controlled_stop},
      {"estop request", [](Inputs& in) { in.requests[index_of(Request::estop)] = true; },
       Cause::operator_estop, Reaction::estop},
      {"estop input", [](Inputs& in) { in.estop_pressed = true; }, Cause::estop_input, Reaction::estop},
      {"state stale", [](Inputs& in) { in.state_stale = true; }, Cause::state_stale, Reaction::ramped_stop},
      {"demand stale", [](Inputs& in) { in.gate_cause = Cause::demand_stale; }, Cause::demand_stale,
       Reaction::ramped_stop},
      {"demand invalid", [](Inputs& in) { in.gate_cause = Cause::demand_invalid; }, Cause::demand_invalid,
       Reaction::ramped_stop},
      {"demand rate", [](Inputs& in) { in.gate_cause = Cause::demand_rate; }, Cause::demand_rate,
       Reaction::ramped_stop},
      {"bridge", [](Inputs& in) { in.bridge_latched = true; }, Cause::bridge_latched, Reaction::power_off},
      {"relay", [](Inputs& in) { in.watchdog_dropped = true; }, Cause::bridge_latched, Reaction::power_off},
      {"position", [](Inputs& in) { in.envelope.position = true; }, Cause::position_limit,
       Reaction::power_off},
      {"stopping", [](Inputs& in) { in.envelope.stopping = true; }, Cause::stopping_envelope,
       Reaction::ramped_stop},
      {"limit switch", [](Inputs& in) { in.envelope.limit_switch = true; }, Cause::limit_switch,
       Reaction::power_off},
      {"overspeed", [](Inputs& in) { in.envelope.overspeed = true; }, Cause::overspeed, Reaction::power_off},
      {"swing", [](Inputs& in) { in.envelope.swing = true; }, Cause::swing_limit, Reaction::controlled_stop},
      {"swing runaway", [](Inputs& in) { in.envelope.swing = in.envelope.swing_runaway = true; },
       Cause::swing_limit, Reaction::ramped_stop},
      {"following", [](Inputs& in) { in.following_error = true; }, Cause::following_error,
       Reaction::power_off},
      {"foreign command", [](Inputs& in) { in.foreign_command = true; }, Cause::second_writer,
       Reaction::fault},
      {"swing sensor", [](Inputs& in) { in.swing_sensor_failed = true; }, Cause::swing_sensor,
       Reaction::ramped_stop},
      {"zone ahead", [](Inputs& in) { in.zone_ahead = true; }, Cause::zone, Reaction::controlled_stop},
      {"zone", [](Inputs& in) { in.zone_ahead = in.zone_touched = true; }, Cause::zone,
       Reaction::ramped_stop},
      {"brake", [](Inputs& in) { in.brakes_open = false; }, Cause::brake_did_not_open, Reaction::power_off},
      {"relay welded", [](Inputs& in) { in.relay_did_not_open = true; }, Cause::relay_did_not_open,
       Reaction::fault},
      {"brake failed", [](Inputs& in) { in.brake_did_not_close = true; }, Cause::brake_did_not_close,
       Reaction::fault},
      {"second writer", [](Inputs& in) { in.second_writer = true; }, Cause::second_writer,
       Reaction::power_off},
      {"configuration", [](Inputs& in) { in.configuration_differs = true; }, Cause::configuration_differs,
       Reaction::power_off},
      {"not homed", [](Inputs& in) { in.not_homed = true; }, Cause::not_homed, Reaction::power_off},
      {"overrun", [](Inputs& in) { in.overrun = true; }, Cause::overrun, Reaction::ramped_stop}};
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
    switch (row.reaction) {
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

/// True if the text contains the figure as whole words: "5 s" is not in "0.5 s" nor in "15 s".
bool states(std::string_view text, std::string_view figure) {
  const auto in_a_word = [](char c) { return c == '.' || std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (auto at = text.find(figure); at != std::string_view::npos; at = text.find(figure, at + 1)) {
    const auto end = at + figure.size();
    if ((at == 0 || !in_a_word(text[at - 1])) && (end == text.size() || !in_a_word(text[end]))) return true;
  }
  return false;
}

/// Number of consecutive ticks with limited rate that stop the crane.
int ticks_with_limited_rate(const Limits& limits) {
  const double largest_v = limits.axis[0].volt_limit_v;
  GateMemory memory;
  memory.last_v[0] = largest_v;  // the output does not follow: the rate is limited in every tick
  for (int ticks = 1; ticks < 100; ++ticks)
    if (gate(limits, {.arrived = true, .demand_v = {-largest_v, 0, 0}, .drives_active = true}, memory)
            .cause == Cause::demand_rate)
      return ticks;
  return 0;
}

std::string figure(double value, const char* unit) {
  std::ostringstream number;
  number << value << ' ' << unit;
  return number.str();
}

/// "3rd ...", for the numbers from 3 to 20.
std::string ordinal(int number) { return std::to_string(number) + (number == 3 ? "rd" : "th"); }

/// The table of docs/safety.md shows these texts; their figures are those of the limits.
TEST(Rules, StateTheFiguresOfTheLimits) {  // S16
  const Limits limits = test_limits();
  const auto milliseconds = [](double value_s) { return figure(std::round(1e3 * value_s), "ms"); };
  const std::string arming = figure(limits.arm_match_time_s, "s"),
                    brake_test = figure(limits.brake_test_time_s, "s"),
                    stop = figure(limits.stop_timeout_s, "s");
  const std::tuple<std::string_view, std::string, const char * Rule::*> figures[] = {
      {"supervisor_brake_did_not_close", milliseconds(limits.period_s + limits.brake_report_time_s),
       &Rule::predicate},
      {"supervisor_relay_did_not_open", milliseconds(limits.period_s + limits.relay_report_time_s),
       &Rule::predicate},
      {"supervisor_bridge_not_ready", arming, &Rule::predicate},
      {"supervisor_bridge_not_ready", arming, &Rule::detection},
      {"supervisor_no_match", arming, &Rule::predicate},
      {"supervisor_no_match", figure(limits.arm_volt_limit_v, "V"), &Rule::predicate},
      {"supervisor_no_match", arming, &Rule::detection},
      {"supervisor_brake_did_not_open", brake_test, &Rule::predicate},
      {"supervisor_brake_did_not_open", brake_test, &Rule::detection},
      {"supervisor_state_stale", ordinal(limits.state_stale_after_ticks), &Rule::detection},
      {"supervisor_demand_stale", ordinal(limits.demand_stale_after_ticks), &Rule::detection},
      {"supervisor_demand_invalid", ordinal(limits.demand_invalid_in_row), &Rule::detection},
      {"supervisor_demand_invalid", figure(kRejectionRatio, "times"), &Rule::predicate},
      {"supervisor_demand_rate", figure(ticks_with_limited_rate(limits), "ticks"), &Rule::detection},
      {"supervisor_overrun", ordinal(limits.overruns_in_row), &Rule::detection},
      {"supervisor_swing_runaway", figure(limits.swing_runaway_ratio, "times"), &Rule::predicate},
      {"supervisor_stop_timeout", stop, &Rule::predicate},
      {"supervisor_stop_timeout", stop, &Rule::detection}};
  for (const auto& [name, value, stated] : figures) {
    const auto rule = std::ranges::find(rules(), name, &Rule::name);
    ASSERT_NE(rule, rules().end()) << name;
    EXPECT_TRUE(states((*rule).*stated, value))
        << name << " states \"" << (*rule).*stated << "\", the limit is " << value;
  }
  const std::string row = "STOP_C1 ramped | " + milliseconds(limits.c1_ramp_time_s) + " | ";
  EXPECT_NE(rule_table().find(row), std::string::npos) << row;
}

}  // namespace
}  // namespace crane::supervisor
