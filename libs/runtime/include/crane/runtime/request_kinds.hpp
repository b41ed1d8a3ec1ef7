#pragma once
/// Which requests stop the crane, which of them are repeated, and how long a request is valid. Supervisor and
/// operator tools use the same rules.
#include <cstdint>

#include "crane/topics.hpp"

namespace crane::runtime {

/// In real time, the supervisor refuses a request that names an older tick. The operator tools wait for an
/// answer for the same time; afterwards, the operator expects no motion.
inline constexpr double kRequestLife_s = 2;
inline constexpr std::int64_t kRequestLife_ns = 2'000'000'000;

/// Stop and emergency stop. The operator tools repeat them until the answer; the dashboard permits them to
/// clients without the controls.
[[nodiscard]] constexpr bool is_urgent_stop(crane_RequestKind kind) noexcept {
  return kind == crane_REQUEST_STOP || kind == crane_REQUEST_ESTOP;
}

/// Requests that stop the crane: the supervisor obeys them at any age, before all others.
[[nodiscard]] constexpr bool stops_crane(crane_RequestKind kind) noexcept {
  return is_urgent_stop(kind) || kind == crane_REQUEST_DISARM;
}

}  // namespace crane::runtime
