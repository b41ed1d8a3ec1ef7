#pragma once
/// Durations of the supervisor process in ticks. In real time, the period of a rig is at least 1 ms.
#include <cmath>
#include <cstdint>

namespace crane::supervisor {

/// @param period_s  > 0
/// @return number of ticks that last at least `duration_s`
[[nodiscard]] inline std::uint64_t ticks_in(double duration_s, double period_s) noexcept {
  constexpr double kRounding = 1e-9;  // 0.5 / 0.01 is 50 ticks
  return static_cast<std::uint64_t>(std::ceil(duration_s / period_s - kRounding));
}

}  // namespace crane::supervisor
