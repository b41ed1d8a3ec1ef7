#pragma once
/// Conversion between topic samples and the types of the supervisor's logic.
#include "crane/supervisor/modes.hpp"
#include "crane/supervisor/supervisor.hpp"
#include "crane/topics.hpp"

namespace crane::supervisor {

[[nodiscard]] Sample sample_of(const msg::State& state);
[[nodiscard]] msg::Command command_of(const msg::Header& header, const TickOutput& output);
/// Content of an accepted move. @pre moves_axes()
[[nodiscard]] msg::AcceptedMove accepted_move(const msg::Request& request, std::uint64_t number);
/// @param move            last accepted move
/// @param jog_deflection  checked deflection of the stick
[[nodiscard]] msg::SupervisorStatus status_of(const msg::Header& header, const TickOutput& output,
                                              const Limits& limits, const msg::AcceptedMove& move,
                                              const PerAxis& jog_deflection, Mode mode);

}  // namespace crane::supervisor
