#pragma once
/// Facts of one row that several invariants use.
#include "campaign/judge/record.hpp"

namespace crane::campaign {

inline constexpr double kVolt = 1e-9;  ///< V: rounding error

/// Duration, ms.
[[nodiscard]] inline double ms(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-6;
}

/// True in the states of a stop: the drives have no power, or lose it. LOCKED is the end of a stop.
[[nodiscard]] inline bool is_stop(crane_SupervisorState state) {
  return state >= crane_STATE_STOP_C1 || state == crane_STATE_LOCKED || state == crane_STATE_SELFTEST;
}

[[nodiscard]] inline bool no_volts(const Row& row) { return row.truth.written_v == PerAxis{}; }
[[nodiscard]] inline bool commanded_closed(const Row& row) { return row.truth.brake_release == AxisFlags{}; }

}  // namespace crane::campaign
