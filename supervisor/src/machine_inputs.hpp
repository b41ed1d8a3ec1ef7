#pragma once
/// Inputs of the state machine: sample, gate and checks of one tick.
#include "crane/supervisor/supervisor.hpp"
#include "crane/supervisor/zone_filter.hpp"

namespace crane::supervisor {

/// True during homing of the axis.
[[nodiscard]] bool is_homing(const TickMemory& memory, std::size_t axis);

/// True when arming opens the brake of the axis: every present axis; during homing only the homed axis.
[[nodiscard]] bool brake_may_open(const Limits& limits, const TickMemory& memory, std::size_t axis);

[[nodiscard]] EnvelopeInput envelope_input(const Limits& limits, const TickInput& input,
                                           const TickMemory& memory);

/// Results of all checks of one tick. No member has a default value: a caller that omits a check does not
/// compile (-Werror).
struct Checks {
  const Envelope& envelope;
  const GateOutput& gated;
  const ZoneVerdict& zone;
  bool brake_did_not_close;  ///< a closed brake does not hold its axis, or does not report closed
  bool relay_did_not_open;   ///< the watchdog relay stays closed without permission
  bool following_error;      ///< see following.hpp
  bool swing_sensor_failed;  ///< see pendulum.hpp
};

[[nodiscard]] Inputs machine_inputs(const Limits& limits, const TickInput& input, const Checks& checks,
                                    const TickMemory& memory);

}  // namespace crane::supervisor
