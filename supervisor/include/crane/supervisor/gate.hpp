#pragma once
/// The command gate: the only way from a demand to a drive. Order: finite, range, rate, freshness, stopping
/// envelope.
#include "crane/supervisor/envelope.hpp"

namespace crane::supervisor {

/// Multiple of a drive's voltage limit that no controller asks for. The largest demand of all controllers in
/// the three maneuvers is 12.8 V of 10 V (gain scheduling, a step of 90 degrees); a step over the whole
/// travel of the slew (8 rad) would make 65 V of it, and three times that is room for other gains.
inline constexpr double kAbsurd = 20;

struct GateInput {
  bool arrived = false;                          ///< the demand of this very tick is here
  PerAxis demand_v{};                            ///< V, any value including NaN; read only when arrived
  bool armed = false;                            ///< the output may reach the drives; otherwise it is 0 V
  AxisFlags block_positive{}, block_negative{};  ///< from Envelope
};

struct GateMemory {
  PerAxis last_v{};        ///< what reached the drives on the tick before
  int missing_in_row = 0;  ///< ticks in a row without a usable demand
  int invalid_in_row = 0;  ///< arrived and rejected, in a row
  int rate_pressure = 0;   ///< +4 per tick clamped in rate, -1 per tick not
  std::uint64_t clamped_count = 0;
  std::uint64_t rejected_count = 0;
  std::uint64_t missing_count = 0;
};

struct GateOutput {
  PerAxis drive_v{};          ///< V, finite, within range and rate; 0 on absent axes
  Cause cause = Cause::none;  ///< none, demand_stale, demand_invalid or demand_rate
  bool clamped = false;       ///< range or rate was limited
  bool invalid = false;       ///< this demand was rejected: a value is not finite, or absurd
  bool stale = false;         ///< too many ticks without a usable demand
  bool near_zero = false;     ///< usable this tick, every present axis within arm_volt_limit_v
};

/// Finite values beyond the range are saturated: gain scheduling asks for 12.8 V of a 10 V drive in an
/// ordinary maneuver. A demand with a value that is not finite, or more than kAbsurd times the limit of a
/// drive, is rejected as a whole: no law of a healthy controller asks for it. Without a usable demand the
/// last output is held until `cause` says stop.
/// @post memory.last_v is unchanged: the caller stores what it really sent
[[nodiscard]] GateOutput gate(const Limits& limits, const GateInput& input, GateMemory& memory) noexcept;

/// rate_pressure that stops the crane: a full reversal and ten more ticks of clamping without a pause.
[[nodiscard]] int rate_pressure_limit(const Limits& limits) noexcept;

}  // namespace crane::supervisor
