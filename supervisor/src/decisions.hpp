#pragma once
// Shared by the sources of the state machine.
#include "crane/supervisor/rules.hpp"

namespace crane::supervisor {

[[nodiscard]] inline bool requested(const Inputs& in, Request request) noexcept {
  return in.requests[static_cast<std::size_t>(request)];
}

/// True in ARMING, HOLD, RUN and STOP_C1: the rules with Scope::armed apply.
[[nodiscard]] inline bool in_armed_scope(const Memory& m) noexcept {
  return m.state == State::arming || m.state == State::hold || m.state == State::run ||
         m.state == State::stop_c1;
}

using Answers = std::array<Answer, kRequests>;

/// Answers to all requests of this tick, after the causes of this tick have changed the state. Stop, disarm
/// and estop are never refused.
[[nodiscard]] Answers answer_all(const Limits& limits, const Inputs& in, const Memory& m) noexcept;

}  // namespace crane::supervisor
