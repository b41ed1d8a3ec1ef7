#pragma once
/// Topic samples as the logic wants them, and back.
#include "crane/supervisor/supervisor.hpp"
#include "crane/topics.hpp"

namespace crane::supervisor {

[[nodiscard]] Sample sample_of(const msg::State& state);
[[nodiscard]] msg::Command command_of(const msg::Header& header, const TickOutput& output);
/// @param move_id  the last move that was accepted
[[nodiscard]] msg::SupervisorStatus status_of(const msg::Header& header, const TickOutput& output,
                                              const Limits& limits, std::uint64_t move_id);

}  // namespace crane::supervisor
