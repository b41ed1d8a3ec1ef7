#pragma once
/// States, causes and reactions of the supervisor. Names and numbers are those of idl/crane.idl, which states
/// the meaning of each state, cause and failure, and what ends it. docs/safety.md draws the states.
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "crane/plant/parameters.hpp"

namespace crane::supervisor {

using plant::kAxes;  ///< 0 trolley (m), 1 slew (rad), 2 hoist (m of cable)
using plant::PerAxis;
using AxisFlags = std::array<bool, kAxes>;

enum class State : std::uint8_t {
  boot,
  selftest,
  locked,
  ready,
  arming,
  hold,
  run,
  stop_c1,
  stop_c0,
  estop,
  fault
};
inline constexpr std::size_t kStates = 11;

/// The causes of crane.idl in lower case.
enum class Cause : std::uint8_t {
#define CRANE_CAUSE(name, text) name,
#include "crane/causes.def"
#undef CRANE_CAUSE
};
inline constexpr std::size_t kCauses =
    std::initializer_list<Cause>{
#define CRANE_CAUSE(name, text) Cause::name,
#include "crane/causes.def"
#undef CRANE_CAUSE
    }
        .size();

/// Reason for which homing of an axis failed.
enum class HomingFailure : std::uint8_t {
  none,
  mark_not_found,
  mark_stuck,
  other_switch,
  no_motion,
  mark_disagrees
};
inline constexpr std::size_t kHomingFailures = 6;

/// Reaction to a cause, in rising severity.
enum class Reaction : std::uint8_t {
  none,
  controlled_stop,  ///< STOP_C1: the controllers bring the axes to rest, then the brakes close
  ramped_stop,      ///< STOP_C1: voltage to zero within the ramp time, then the brakes close at once
  power_off,        ///< STOP_C0: 0 V and brakes closed in the same tick
  estop,            ///< ESTOP: as STOP_C0, until the emergency stop is released and a reset follows
  fault             ///< FAULT: as STOP_C0, until the supervisor is restarted
};

/// Name of crane.idl without its prefix: "STOP_C1", "SWING_LIMIT".
[[nodiscard]] const char* name_of(State state) noexcept;
[[nodiscard]] const char* name_of(Cause cause) noexcept;

/// Action of the operator, from the rule table (rules.hpp); START: "reset, then arm", NONE: "nothing to do".
[[nodiscard]] const char* remedy_for(Cause cause) noexcept;

/// True for the causes of a stop that no fault required: START, HOMED, OPERATOR_DISARM and IDLE. Only after
/// such a stop may a program reset the crane by itself.
[[nodiscard]] bool is_routine(Cause cause) noexcept;

/// "MARK_STUCK" and the remedy; empty for none.
[[nodiscard]] const char* name_of(HomingFailure failure) noexcept;
[[nodiscard]] const char* remedy_for(HomingFailure failure) noexcept;

}  // namespace crane::supervisor
