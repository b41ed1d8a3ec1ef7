#pragma once
/// Requests and samples of the stick that a recording lacks. A recorder does not receive the request of a
/// program that ends before the recorder has discovered it, for example of `crane stop`. The reply and the
/// statuses of the supervisor before and after the decision show what the request was.
#include <optional>
#include <string>

#include "crane/topics.hpp"

namespace crane::replay {

/// @param reply   of an accepted request that is not recorded
/// @param before  status of the tick before the decision
/// @param after   status of the tick of the decision
/// @return the request, with the id and the client of the reply; nothing when the status shows no effect
[[nodiscard]] std::optional<msg::Request> request_behind(const msg::Reply& reply,
                                                         const msg::SupervisorStatus& before,
                                                         const msg::SupervisorStatus& after);

/// The sample of crane/jog that a recording lacks for the same reason, at the beginning of a session.
/// @return the sample with the deflection of the status; nothing when the stick has none. In maintenance, the
/// status does not show the deflection of the sample
[[nodiscard]] std::optional<msg::Jog> jog_behind(const msg::SupervisorStatus& status);
/// The sample with which the program of `jog` releases the stick, at this status.
[[nodiscard]] msg::Jog released(msg::Jog jog, const msg::SupervisorStatus& status);

/// "move of client 'crane 4711'"
[[nodiscard]] std::string in_words(const msg::Request& request);

}  // namespace crane::replay
