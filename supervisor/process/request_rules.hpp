#pragma once
/// What a request has to be before the state machine is asked about it.
#include <optional>
#include <string>

#include "crane/supervisor/limits.hpp"
#include "crane/supervisor/state_machine.hpp"
#include "crane/topics.hpp"

namespace crane::supervisor {

/// Nothing: the supervisor does not act on this kind.
[[nodiscard]] std::optional<Request> request_of(crane_RequestKind kind);
/// A move, or a reference to follow.
[[nodiscard]] bool moves_axes(const msg::Request& request);
/// Why the axes, targets or sines of this request are not allowed; empty when they are.
[[nodiscard]] std::string problem_of(const msg::Request& request, const Limits& limits);
/// The axis that it is to home. @pre problem_of() is empty
[[nodiscard]] std::size_t home_axis_of(const msg::Request& request);

}  // namespace crane::supervisor
