#pragma once
// What the parts of the state machine share.
#include "crane/supervisor/rules.hpp"

namespace crane::supervisor {

[[nodiscard]] inline bool asked(const Inputs& in, Request request) noexcept {
  return in.requests[static_cast<std::size_t>(request)];
}

/// The brakes are, or are about to be, open: the whole set of causes applies.
[[nodiscard]] inline bool armed(const Memory& m) noexcept {
  return m.state == State::arming || m.state == State::hold || m.state == State::run ||
         m.state == State::stop_c1;
}

using Answers = std::array<Answer, kRequests>;

/// The answers to all requests of this tick, in the state that its causes have left. Stop, disarm and estop
/// are never refused.
[[nodiscard]] Answers answer_all(const Limits& limits, const Inputs& in, const Memory& m) noexcept;

}  // namespace crane::supervisor
