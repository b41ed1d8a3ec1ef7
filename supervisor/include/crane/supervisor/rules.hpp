#pragma once
/// The rule table: what stops the crane, in the order in which it is looked for. The state machine runs this
/// table; docs/safety.md and `crane supervisor explain` print it.
#include <span>
#include <string>
#include <string_view>

#include "crane/protection.hpp"
#include "crane/supervisor/state_machine.hpp"

namespace crane::supervisor {

/// In which states a rule is looked at.
enum class Scope : std::uint8_t {
  restart,         ///< in every state but ESTOP and FAULT
  always,          ///< in every state
  past_self_test,  ///< in every state but BOOT and SELFTEST
  selftest,        ///< in SELFTEST
  armed,           ///< while the brakes are, or are about to be, open: ARMING, HOLD, RUN, STOP_C1
  arming           ///< in ARMING
};

struct Rule {
  std::string_view name;  ///< in the mutation check, tests/campaign
  Cause cause;
  Reaction reaction;
  Scope scope;
  bool blocks;  ///< stands against a reset and against READY
  bool (*holds)(const Limits&, const Inputs&, const Memory&) noexcept;
  const char* predicate;  ///< what `holds` looks at, in words
  const char* detection;  ///< from the first sample that shows it to the reaction
  const char* remedy;     ///< what the operator can do about it; never empty
};

/// From the severest group to the mildest; within a group the first that holds is the cause.
[[nodiscard]] std::span<const Rule> rules() noexcept;

struct Finding {
  Cause cause = Cause::none;
  Reaction reaction = Reaction::none;
};

/// The severest cause of this tick.
[[nodiscard]] Finding worst_cause(const Limits& limits, const Inputs& in, const Memory& m) noexcept;

/// What stands against a reset, and takes READY back to LOCKED. A latched bridge and a dropped watchdog do
/// not: both need the watchdog permission that comes with the reset.
[[nodiscard]] Cause blocking_cause(const Limits& limits, const Inputs& in, const Memory& m) noexcept;

/// The table as Markdown, as docs/safety.md shows it.
[[nodiscard]] std::string rule_table();

}  // namespace crane::supervisor
