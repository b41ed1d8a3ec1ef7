#pragma once
/// Samples of the stick that a recording lacks. A recorder does not receive what a program publishes before
/// the recorder has discovered it. The statuses of the supervisor show the deflection.
#include <optional>

#include "crane/topics.hpp"

namespace crane::replay {

/// @param epoch  of the program whose session the status shows
/// @return the sample with the deflection of the status; nothing when the stick has none. In maintenance, the
/// status does not show the deflection of the sample
[[nodiscard]] std::optional<msg::Jog> jog_behind(const msg::SupervisorStatus& status, std::uint32_t epoch);
/// The sample with which the program of `jog` releases the stick, at this status.
[[nodiscard]] msg::Jog released(msg::Jog jog, const msg::SupervisorStatus& status);

}  // namespace crane::replay
