#include "crane/supervisor/states.hpp"

namespace crane::supervisor {
namespace {

struct CauseEntry {
  Cause cause;
  Reaction reaction;
  const char* name;
  const char* remedy;
};

// In the order of the enumeration, so that a cause is its own index.
constexpr std::array<CauseEntry, kCauses> kTable{{
    {Cause::none, Reaction::none, "NONE", "nothing to do"},
    {Cause::start, Reaction::none, "START", "reset, then arm"},
    {Cause::operator_stop, Reaction::controlled_stop, "OPERATOR_STOP", "reset, then arm"},
    {Cause::operator_disarm, Reaction::controlled_stop, "OPERATOR_DISARM", "reset, then arm"},
    {Cause::operator_estop, Reaction::estop, "OPERATOR_ESTOP", "find out why it was stopped, then reset"},
    {Cause::estop_input, Reaction::estop, "ESTOP_INPUT",
     "release the emergency stop, wait a second, then reset"},
    {Cause::idle, Reaction::controlled_stop, "IDLE", "reset, then arm"},
    {Cause::state_stale, Reaction::ramped_stop, "STATE_STALE",
     "no crane/state arrives: check that the bridge or the simulated plant runs"},
    {Cause::demand_stale, Reaction::ramped_stop, "DEMAND_STALE",
     "no crane/demand arrives: check planner, tracking, anti_swing and friction_compensation"},
    {Cause::demand_invalid, Reaction::ramped_stop, "DEMAND_INVALID",
     "a controller publishes values that are not finite, or absurdly large: check its gains and inputs"},
    {Cause::demand_rate, Reaction::ramped_stop, "DEMAND_RATE",
     "the demand jumps, or does not match a crane at rest: check the controller and its reference"},
    {Cause::bridge_latched, Reaction::power_off, "BRIDGE_LATCHED",
     "the bridge or its relay has stopped the crane: look at the bridge's events, then reset"},
    {Cause::position_limit, Reaction::power_off, "POSITION_LIMIT",
     "bring the axis back inside its limits by hand"},
    {Cause::stopping_envelope, Reaction::ramped_stop, "STOPPING_ENVELOPE",
     "the axis would not have stopped before its limit, or moved while its brake opened: check target and "
     "load"},
    {Cause::limit_switch, Reaction::power_off, "LIMIT_SWITCH", "bring the axis off its limit switch by hand"},
    {Cause::overspeed, Reaction::power_off, "OVERSPEED",
     "check encoder, amplifier and the controller's gains"},
    {Cause::swing_limit, Reaction::controlled_stop, "SWING_LIMIT",
     "wait until the load swings less, then reset"},
    {Cause::brake_did_not_close, Reaction::fault, "BRAKE_DID_NOT_CLOSE",
     "check the brakes, then restart the supervisor"},
    {Cause::brake_did_not_open, Reaction::power_off, "BRAKE_DID_NOT_OPEN",
     "check the brake supply and its relay"},
    {Cause::second_writer, Reaction::power_off, "SECOND_WRITER",
     "two processes write the same topic: end one of them, or give each crane its own name or domain"},
    {Cause::overrun, Reaction::ramped_stop, "OVERRUN",
     "the computer is too busy: give the stack real-time priority"},
    {Cause::selftest_failed, Reaction::fault, "SELFTEST_FAILED",
     "look at the events of the self-test, then restart the supervisor"},
    {Cause::stop_timeout, Reaction::ramped_stop, "STOP_TIMEOUT",
     "the controllers did not bring the crane to rest in time: check them, then reset"},
    {Cause::not_homed, Reaction::power_off, "NOT_HOMED",
     "the position of an axis is not known: reset, then `crane home` (with --axis for one of them)"},
    {Cause::homed, Reaction::controlled_stop, "HOMED", "the axis has found its mark: reset, then arm"},
    {Cause::homing_failed, Reaction::power_off, "HOMING_FAILED",
     "`crane status` and the events say why; remove the cause, reset, then `crane home`"},
    {Cause::bridge_restarted, Reaction::power_off, "BRIDGE_RESTARTED",
     "the positions are those of a new bridge: look where the axes stand, then reset"},
}};

constexpr bool table_is_in_order() {
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    if (static_cast<std::size_t>(kTable[i].cause) != i) return false;
  }
  return true;
}
static_assert(table_is_in_order());

constexpr std::array<const char*, kStates> kStateNames{
    "BOOT", "SELFTEST", "LOCKED", "READY", "ARMING", "HOLD", "RUN", "STOP_C1", "STOP_C0", "ESTOP", "FAULT"};

struct FailureEntry {
  const char* name;
  const char* remedy;
};
// In the order of the enumeration.
constexpr std::array<FailureEntry, kHomingFailures> kFailures{{
    {"NONE", ""},
    {"MARK_NOT_FOUND", "the axis crept its whole travel without its mark: check switch and counts per unit"},
    {"MARK_STUCK", "the mark's switch does not open when the axis leaves it: check switch and wiring"},
    {"OTHER_SWITCH", "the limit switch of the other end was reached: check mark, signs and wiring"},
    {"NO_MOTION", "the axis does not follow: check encoder, brake and drive"},
    {"MARK_DISAGREES", "the mark was seen at two places: check coupling, encoder and switch"},
}};

}  // namespace

Reaction reaction_to(Cause cause) noexcept { return kTable[static_cast<std::size_t>(cause)].reaction; }
const char* name_of(State state) noexcept { return kStateNames[static_cast<std::size_t>(state)]; }
const char* name_of(Cause cause) noexcept { return kTable[static_cast<std::size_t>(cause)].name; }
const char* remedy_for(Cause cause) noexcept { return kTable[static_cast<std::size_t>(cause)].remedy; }
const char* name_of(HomingFailure failure) noexcept {
  return kFailures[static_cast<std::size_t>(failure)].name;
}
const char* remedy_for(HomingFailure failure) noexcept {
  return kFailures[static_cast<std::size_t>(failure)].remedy;
}

}  // namespace crane::supervisor
