#include "crane/supervisor/rules.hpp"

#include <algorithm>
#include <array>

#include "decisions.hpp"

namespace crane::supervisor {
namespace {

using L = const Limits&;
using I = const Inputs&;
using M = const Memory&;

// In ARMING, the supervisor waits for the bridge until it commands the brakes open. From then on, a
// stopped bridge stops the crane.
bool bridge_must_be_ready(M m) noexcept { return m.state != State::arming || m.releasing; }

bool bridge_stopped(I in) noexcept { return in.bridge_latched || in.watchdog_dropped; }

bool match_is_late(L limits, I in, M m) noexcept {
  return !m.releasing && in.now_s - m.entered_s >= limits.arm_match_time_s;
}

bool opening_is_late(L limits, I in, M m) noexcept {
  return m.releasing && in.now_s - m.release_since_s >= limits.brake_test_time_s;
}

constexpr const char* kCheckBrakes = "check the brakes, then restart the supervisor";
constexpr const char* kWeldedRelay =
    "the contacts of the watchdog relay may be welded, or its contact input is wrong: check them, then "
    "restart the supervisor";
constexpr const char* kBridgeStopped =
    "the bridge or its relay has stopped the crane: read the events of the bridge, then reset";
constexpr const char* kTwoWriters =
    "two processes write the same topic, or one forges commands: end one of them, give each crane its own "
    "name or domain, or use keys (crane up --secure)";
constexpr const char* kOtherConfiguration =
    "the processes have different rig files or controllers (the event names the processes): restart them "
    "with the same rig file and controller, then reset";
constexpr const char* kBrakeSupply = "check the brake supply and its relay";
constexpr const char* kEnvelope =
    "the axis would not have stopped before its limit, or moved while its brake opened: check target and "
    "load";
constexpr const char* kDemandJumps =
    "the demand jumps, or is too large for a crane at rest: wait until the load hangs still, then reset; if "
    "this repeats, check the controller and its reference";
constexpr const char* kFollowing =
    "the axis does not follow its voltage: check amplifier, encoder, brake and load, then reset";
constexpr const char* kSwing = "wait until the load swings less, then reset";
constexpr const char* kZone =
    "the event names the zone (`crane zone list` shows all zones): let the load hang at rest, reset, arm, "
    "then move away from the zone, slowly at first";
constexpr const char* kResetArm = "reset, then arm";

// clang-format off
constexpr std::array kRules{
    Rule{"supervisor_brake_did_not_close", Cause::brake_did_not_close, Reaction::fault, Scope::past_self_test, false,
         [](L, I in, M) noexcept { return in.brake_did_not_close; },
         "an axis moves by more than twice its stopping distance plus `brake_slip` after the command to close its brake, or the "
         "brake does not report closed within its closing time plus 110 ms", "same tick", kCheckBrakes},
    Rule{"supervisor_relay_did_not_open", Cause::relay_did_not_open, Reaction::fault, Scope::past_self_test, false,
         [](L, I in, M) noexcept { return in.relay_did_not_open; },
         "without permission, the watchdog relay reports closed for `relay_timeout_s` plus 110 ms", "same tick", kWeldedRelay},
    Rule{"supervisor_selftest_failed", Cause::selftest_failed, Reaction::fault, Scope::selftest, false,
         [](L, I in, M) noexcept { return in.self_test == SelfTest::failed; },
         "the board does not show 0 V, closed brakes and open relay for 0.1 s", "2 s",
         "read the events of the self-test, then restart the supervisor"},
    Rule{"supervisor_foreign_command", Cause::second_writer, Reaction::fault, Scope::always, false,
         [](L, I in, M) noexcept { return in.foreign_command; },
         "the bridge outputs a voltage that no command of the supervisor explains; the supervisor then exits",
         "2nd state in a row", kTwoWriters},
    Rule{"supervisor_estop_input", Cause::estop_input, Reaction::estop, Scope::always, true,
         [](L, I in, M) noexcept { return in.estop_pressed; },
         "the emergency stop of the rig is pressed", "same tick", "release the emergency stop, wait a second, then reset"},
    Rule{"supervisor_operator_estop", Cause::operator_estop, Reaction::estop, Scope::always, false,
         [](L, I in, M) noexcept { return requested(in, Request::estop); },
         "request `estop`", "same tick", "find the reason for the stop, then reset"},
    Rule{"supervisor_second_writer", Cause::second_writer, Reaction::power_off, Scope::armed, true,
         [](L, I in, M) noexcept { return in.second_writer; },
         "a loop topic has had a second writer within the last second", "same tick; 1 tick later when another process detects it",
         kTwoWriters},
    Rule{"supervisor_configuration_differs", Cause::configuration_differs, Reaction::power_off, Scope::armed, true,
         [](L, I in, M) noexcept { return in.configuration_differs; },
         "a value in the rig file of a process of the loop differs from that of the supervisor, or two processes have different controllers",
         "same tick", kOtherConfiguration},
    Rule{"supervisor_bridge_latched", Cause::bridge_latched, Reaction::power_off, Scope::armed, false,
         [](L, I in, M m) noexcept { return bridge_stopped(in) && bridge_must_be_ready(m); },
         "the bridge has latched, or the watchdog relay is open", "same tick", kBridgeStopped},
    Rule{"supervisor_not_homed", Cause::not_homed, Reaction::power_off, Scope::armed, false,
         [](L, I in, M m) noexcept { return in.not_homed && !m.homing; },
         "the position of an axis has become unknown", "same tick",
         "reset, then `crane home` (with --axis for one axis)"},
    Rule{"supervisor_homing_failed", Cause::homing_failed, Reaction::power_off, Scope::armed, false,
         [](L, I in, M m) noexcept {
           return m.homing && m.state == State::run && in.homing_failure != HomingFailure::none;
         },
         "homing has ended without a position", "same tick",
         "`crane status` and the events state the cause; remove it, reset, then `crane home`"},
    Rule{"supervisor_position_limit", Cause::position_limit, Reaction::power_off, Scope::armed, true,
         [](L, I in, M) noexcept { return in.envelope.position; },
         "an axis is beyond a hard limit", "same tick", "move the axis back inside its limits by hand"},
    Rule{"supervisor_limit_switch", Cause::limit_switch, Reaction::power_off, Scope::armed, true,
         [](L, I in, M) noexcept { return in.envelope.limit_switch; },
         "a limit switch is pressed", "same tick", "move the axis off its limit switch by hand"},
    Rule{"supervisor_overspeed", Cause::overspeed, Reaction::power_off, Scope::armed, false,
         [](L, I in, M) noexcept { return in.envelope.overspeed; },
         "an axis is faster than the share of `max_speed` that the operating mode permits, or its encoder jumps", "same tick",
         "check encoder, amplifier and gains of the controller, and the largest speed of the operating mode"},
    Rule{"supervisor_brake_closed_itself", Cause::brake_did_not_open, Reaction::power_off, Scope::armed, false,
         [](L, I in, M m) noexcept { return drives_active(m) && !in.brakes_open; },
         "a brake reports closed while the drives are active", "same tick", kBrakeSupply},
    Rule{"supervisor_following_error", Cause::following_error, Reaction::power_off, Scope::armed, false,
         [](L, I in, M) noexcept { return in.following_error; },
         "the speed of an axis differs from what its voltage explains by more than 5 % of `max_speed` plus 5 % of the speed plus the quantisation",
         "two ticks, plus the limit divided by the unexplained acceleration", kFollowing},
    Rule{"supervisor_bridge_not_ready", Cause::bridge_latched, Reaction::power_off, Scope::arming, false,
         [](L limits, I in, M m) noexcept { return match_is_late(limits, in, m) && bridge_stopped(in); },
         "bridge or relay is not ready 5 s after `arm`", "5 s", kBridgeStopped},
    Rule{"supervisor_no_match", Cause::demand_rate, Reaction::ramped_stop, Scope::arming, false,
         [](L limits, I in, M m) noexcept { return match_is_late(limits, in, m) && !bridge_stopped(in); },
         "no demand of at most 2.5 V on each axis within 5 s after `arm`", "5 s", kDemandJumps},
    Rule{"supervisor_moved_while_arming", Cause::stopping_envelope, Reaction::ramped_stop, Scope::arming, false,
         [](L, I in, M m) noexcept { return m.releasing && in.moved_while_arming; },
         "an axis moves more than `brake_slip` while the brakes open", "same tick", kEnvelope},
    Rule{"supervisor_brake_did_not_open", Cause::brake_did_not_open, Reaction::power_off, Scope::arming, false,
         [](L limits, I in, M m) noexcept { return opening_is_late(limits, in, m) && !in.brakes_open; },
         "a brake reports closed 0.2 s after the command to open", "0.2 s", kBrakeSupply},
    Rule{"supervisor_state_stale", Cause::state_stale, Reaction::ramped_stop, Scope::armed, true,
         [](L, I in, M) noexcept { return in.state_stale; },
         "`crane/state` is missing in three steps in a row", "3rd step in a row",
         "no crane/state arrives: check that the bridge or the simulated plant runs"},
    Rule{"supervisor_demand_stale", Cause::demand_stale, Reaction::ramped_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return in.gate_cause == Cause::demand_stale; },
         "no usable `crane/demand` for `demand_stale_after_s`", "3rd tick in a row",
         "no crane/demand arrives: check planner, tracking, anti_swing and friction_compensation"},
    Rule{"supervisor_demand_invalid", Cause::demand_invalid, Reaction::ramped_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return in.gate_cause == Cause::demand_invalid; },
         "a demand is not finite, or more than 20 times the limit of a drive", "3rd tick in a row",
         "a controller publishes values that are not finite or far too large: check its gains and inputs"},
    Rule{"supervisor_demand_rate", Cause::demand_rate, Reaction::ramped_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return in.gate_cause == Cause::demand_rate; },
         "the gate limits the rate of the demand in too many ticks",
         "12 ticks in a row; more if not every tick is limited or `volt_rate_limit_vps` is low", kDemandJumps},
    Rule{"supervisor_overrun", Cause::overrun, Reaction::ramped_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return in.overrun; },
         "ticks of the bridge are late by more than half a period", "3rd tick in a row",
         "the computer is too busy: give the stack real-time priority"},
    Rule{"supervisor_stopping_envelope", Cause::stopping_envelope, Reaction::ramped_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return in.envelope.stopping; },
         "an axis cannot stop before a hard limit; from then on no voltage outwards", "same tick", kEnvelope},
    Rule{"supervisor_zone", Cause::zone, Reaction::ramped_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return in.zone_touched; },
         "a ramped stop that begins one tick later could let load, hook or cable swing into a no-go zone; from then on 0 V",
         "same tick", kZone},
    Rule{"supervisor_swing_runaway", Cause::swing_limit, Reaction::ramped_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return in.envelope.swing_runaway; },
         "the load swings farther than 1.25 times `swing_limit_rad`", "same tick", kSwing},
    Rule{"supervisor_swing_sensor", Cause::swing_sensor, Reaction::ramped_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return in.swing_sensor_failed; },
         "the measured load does not move as a pendulum under the measured trolley",
         "190 ms for an error of 0.1 rad at 1 m of cable (tower)", "check the encoders of swing, trolley and slew, and their cables, then reset"},
    Rule{"supervisor_stop_timeout", Cause::stop_timeout, Reaction::ramped_stop, Scope::armed, false,
         [](L limits, I in, M m) noexcept {
           return m.state == State::stop_c1 && in.now_s - m.entered_s >= limits.stop_timeout_s;
         },
         "a controlled stop has not ended within 8 s", "8 s",
         "the controllers did not bring the crane to rest in time: check them, then reset"},
    Rule{"supervisor_swing_limit", Cause::swing_limit, Reaction::controlled_stop, Scope::armed, true,
         [](L, I in, M) noexcept { return in.envelope.swing; },
         "the load swings farther than `swing_limit_rad`", "same tick", kSwing},
    Rule{"supervisor_operator_stop", Cause::operator_stop, Reaction::controlled_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return requested(in, Request::stop); }, "request `stop`", "same tick", kResetArm},
    Rule{"supervisor_operator_disarm", Cause::operator_disarm, Reaction::controlled_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return requested(in, Request::disarm); }, "request `disarm`", "same tick", kResetArm},
    Rule{"supervisor_zone_ahead", Cause::zone, Reaction::controlled_stop, Scope::armed, false,
         [](L, I in, M) noexcept { return in.zone_ahead; },
         "a controlled stop must begin now, so that no ramped stop becomes necessary at a no-go zone", "same tick", kZone},
    Rule{"supervisor_homed", Cause::homed, Reaction::controlled_stop, Scope::armed, false,
         [](L, I in, M m) noexcept { return m.homing && m.state == State::run && in.homed; },
         "homing has found and left the mark", "same tick", "the axis has found its mark: reset, then arm"},
    Rule{"supervisor_idle", Cause::idle, Reaction::controlled_stop, Scope::armed, false,
         [](L limits, I in, M m) noexcept {
           return m.state == State::hold && in.now_s - m.idle_since_s >= limits.idle_lock_s;
         },
         "HOLD without a move for `idle_lock_s`", "same tick", kResetArm},
    Rule{"supervisor_bridge_restarted", Cause::bridge_restarted, Reaction::none, Scope::restart, false,
         [](L, I in, M) noexcept { return in.bridge_restarted; },
         "another bridge writes `crane/state`: SELFTEST, then LOCKED", "first state of the new bridge",
         "the positions come from a new bridge: check where the axes are, then reset"},
};
// clang-format on

constexpr bool names_differ() {
  for (std::size_t i = 0; i < kRules.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (kRules[i].name == kRules[k].name) return false;
  return true;
}
static_assert(names_differ());

constexpr bool every_cause_has_a_rule() {
  for (std::size_t cause = 0; cause < kCauses; ++cause)
    if (static_cast<Cause>(cause) != Cause::none && static_cast<Cause>(cause) != Cause::start &&
        std::ranges::none_of(
            kRules, [cause](const Rule& rule) { return static_cast<std::size_t>(rule.cause) == cause; }))
      return false;
  return true;
}
static_assert(every_cause_has_a_rule());

bool in_scope(Scope scope, M m) noexcept {
  switch (scope) {
    case Scope::restart:
      return false;
    case Scope::always:
      return true;
    case Scope::past_self_test:
      return m.state != State::boot && m.state != State::selftest;
    case Scope::selftest:
      return m.state == State::selftest;
    case Scope::armed:
      return in_armed_scope(m);
    case Scope::arming:
      return m.state == State::arming;
  }
  return false;
}

struct ReactionWords {
  const char* reaction;
  const char* zero_volts;
  const char* brakes;
};
constexpr std::array<ReactionWords, 6> kReactions{{{"", "", ""},
                                                   {"STOP_C1 controlled", "standstill", "standstill"},
                                                   {"STOP_C1 ramped", "20 ms", "20 ms"},
                                                   {"STOP_C0", "10 ms", "10 ms"},
                                                   {"ESTOP", "10 ms", "10 ms"},
                                                   {"FAULT", "10 ms", "10 ms"}}};

}  // namespace

std::span<const Rule> rules() noexcept { return kRules; }

Finding first_matching_cause(const Limits& limits, const Inputs& in, const Memory& m) noexcept {
  for (const Rule& rule : kRules)
    if (protection::enabled(rule.name) && in_scope(rule.scope, m) && rule.holds(limits, in, m))
      return {rule.cause, rule.reaction};
  return {};
}

Cause blocking_cause(const Limits& limits, const Inputs& in, const Memory& m) noexcept {
  for (const Rule& rule : kRules)
    if (rule.blocks && protection::enabled(rule.name) && rule.holds(limits, in, m)) return rule.cause;
  return Cause::none;
}

const char* remedy_for(Cause cause) noexcept {
  const auto* rule = std::ranges::find(kRules, cause, &Rule::cause);
  if (rule != kRules.end()) return rule->remedy;
  return cause == Cause::none ? "nothing to do" : kResetArm;
}

std::string rule_table() {
  std::string table =
      "| cause | condition | detection | reaction | 0 V | brakes commanded closed | remedy "
      "|\n|---|---|---|---|---|---|---|\n";
  for (const Rule& rule : kRules) {
    const auto& words = rule.scope == Scope::restart ? ReactionWords{"SELFTEST, LOCKED", "10 ms", "10 ms"}
                                                     : kReactions[static_cast<std::size_t>(rule.reaction)];
    for (const char* cell : {name_of(rule.cause), rule.predicate, rule.detection, words.reaction,
                             words.zero_volts, words.brakes, rule.remedy})
      table += std::string{"| "} + cell + " ";
    table += "|\n";
  }
  return table;
}

}  // namespace crane::supervisor
