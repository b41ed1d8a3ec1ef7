#pragma once
/// The rule table: all causes that stop the crane, in the order of their checks. The state machine evaluates
/// the table; docs/safety.md and `crane supervisor explain` print it.
#include <span>
#include <string>
#include <string_view>

#include "crane/protection.hpp"
#include "crane/supervisor/state_machine.hpp"

namespace crane::supervisor {

/// States in which a rule is checked.
enum class Scope : std::uint8_t {
  restart,         ///< all states except ESTOP and FAULT; step() handles a restart before the other rules
  always,          ///< all states
  past_self_test,  ///< all states except BOOT and SELFTEST
  selftest,        ///< SELFTEST
  armed,           ///< ARMING, HOLD, RUN, STOP_C1; in ARMING and STOP_C1 the brakes may be closed
  arming           ///< ARMING
};

struct Rule {
  std::string_view name;  ///< name of the rule in the mutation check (tests/campaign)
  Cause cause;
  Reaction reaction;
  Scope scope;
  bool blocks;  ///< true: the cause also refuses a reset, and takes READY back to LOCKED
  bool (*holds)(const Limits&, const Inputs&, const Memory&) noexcept;
  const char* predicate;  ///< condition of `holds` in words
  const char* detection;  ///< time from the first sample that shows the cause to the reaction
  const char* remedy;     ///< action of the operator; never empty
};

/// All rules in the order of evaluation: the first rule that holds determines the cause. The reactions are
/// sorted by decreasing severity, except for the rules of ARMING and of a restart.
[[nodiscard]] std::span<const Rule> rules() noexcept;

struct Finding {
  Cause cause = Cause::none;
  Reaction reaction = Reaction::none;
};

/// The first rule that holds in this tick.
[[nodiscard]] Finding first_matching_cause(const Limits& limits, const Inputs& in, const Memory& m) noexcept;

/// First cause that refuses a reset and takes READY back to LOCKED. A latched bridge and an open watchdog
/// relay do not refuse a reset, because both need the watchdog permission that the reset gives.
[[nodiscard]] Cause blocking_cause(const Limits& limits, const Inputs& in, const Memory& m) noexcept;

/// The table as Markdown, as docs/safety.md shows it.
[[nodiscard]] std::string rule_table();

}  // namespace crane::supervisor
