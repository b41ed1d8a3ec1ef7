#pragma once
/// Conversion between topic samples and the types of the supervisor's logic.
#include "crane/supervisor/supervisor.hpp"
#include "crane/topics.hpp"

namespace crane::supervisor {

[[nodiscard]] Sample sample_of(const msg::State& state);
[[nodiscard]] msg::Command command_of(const msg::Header& header, const TickOutput& output);
/// Content of an accepted move. @pre its kind is REQUEST_MOVE or REQUEST_FOLLOW
[[nodiscard]] msg::AcceptedMove accepted_move(const msg::Request& request, std::uint64_t number);
/// @param move  last accepted move
[[nodiscard]] msg::SupervisorStatus status_of(const msg::Header& header, const TickOutput& output,
                                              const Limits& limits, const msg::AcceptedMove& move);

}  // namespace crane::supervisor
