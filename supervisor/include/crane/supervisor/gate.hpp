#pragma once
/// The command gate: every demand passes the gate before it reaches a drive.
/// docs/safety.md#the-gate-and-the-stopping-distance lists the stages in their order.
#include "crane/supervisor/envelope.hpp"

namespace crane::supervisor {

/// Multiple of a drive's voltage limit above which a demand is rejected. The largest demand of all
/// controllers in the three maneuvers is 12.8 V for a limit of 10 V (gain scheduling, step of 90 degrees). A
/// step over the whole travel of the slew axis (8 rad) would demand 65 V; the remaining factor of 3 admits
/// larger gains.
inline constexpr double kRejectionRatio = 20;

struct GateInput {
  bool arrived = false;        ///< true: the demand of this tick has arrived
  PerAxis demand_v{};          ///< V, any value including NaN; valid when arrived
  bool drives_active = false;  ///< drives_active() of the state machine; false: the output is 0 V
  AxisFlags block_positive{}, block_negative{};  ///< from Envelope
};

struct GateMemory {
  PerAxis last_v{};        ///< V, output of the previous tick
  int missing_in_row = 0;  ///< consecutive ticks without a usable demand
  int invalid_in_row = 0;  ///< consecutive rejected demands
  int rate_pressure = 0;   ///< +4 for each tick with limited rate, -1 for every other tick, >= 0
  std::uint64_t clamped_count = 0;
  std::uint64_t rejected_count = 0;
  std::uint64_t missing_count = 0;
};

struct GateOutput {
  /// V, finite, within range and rate; 0 on absent axes. A voltage in a blocked direction becomes 0
  /// at once, without rate limit.
  PerAxis drive_v{};
  Cause cause = Cause::none;  ///< none, demand_stale, demand_invalid or demand_rate
  bool clamped = false;       ///< true: range or rate was limited
  bool invalid = false;    ///< true: the demand was rejected: a value is not finite, or above kRejectionRatio
  bool stale = false;      ///< true: too many consecutive ticks without a usable demand
  bool near_zero = false;  ///< true: usable demand, all present axes within arm_volt_limit_v
};

/// Executes the stages of docs/safety.md#the-gate-and-the-stopping-distance up to the stopping envelope. A
/// demand with a value that is not finite, or that exceeds kRejectionRatio times the limit of its drive, is
/// rejected as a whole. Without a usable demand the last output is held until `cause` stops the crane.
/// @post memory.last_v is unchanged: the caller stores the voltage that it sends
[[nodiscard]] GateOutput gate(const Limits& limits, const GateInput& input, GateMemory& memory) noexcept;

/// Value of rate_pressure that stops the crane. A demand reaches it by a full reversal and ten more
/// consecutive ticks with limited rate.
[[nodiscard]] int rate_pressure_limit(const Limits& limits) noexcept;

}  // namespace crane::supervisor
