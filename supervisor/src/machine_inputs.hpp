#pragma once
/// Inputs of the state machine: sample, gate and checks of one tick.
#include "crane/supervisor/supervisor.hpp"

namespace crane::supervisor {

/// True during homing of the axis.
[[nodiscard]] bool is_homing(const TickMemory& memory, std::size_t axis);

/// True when arming opens the brake of the axis: every present axis; during homing only the homed axis.
[[nodiscard]] bool takes_part(const Limits& limits, const TickMemory& memory, std::size_t axis);

[[nodiscard]] EnvelopeInput measured_now(const Limits& limits, const TickInput& input,
                                         const TickMemory& memory);

/// @param brakes_failed  a closed brake does not hold its axis, or does not report closed
/// @param relay_stuck    the watchdog relay stays closed without permission
/// @return inputs without the results of the model checks and of the zone filter
[[nodiscard]] Inputs machine_inputs(const Limits& limits, const TickInput& input, const Envelope& envelope,
                                    const GateOutput& gated, bool brakes_failed, bool relay_stuck,
                                    const TickMemory& memory);

}  // namespace crane::supervisor
