#pragma once
/// The request "hold here".
#include <array>
#include <cstdint>

#include "stack/operator_client.hpp"

namespace crane::dashboard {

/// Largest age of the crane/state from which the target of a hold is computed: more than two
/// periods of the slowest loop (0.1 s). In this time, an axis at 0.5 m/s moves by 0.13 m.
inline constexpr std::int64_t kHoldAge_ns = 250'000'000;

/// True for the request `hold`: a move without selected axes, which move_to_rest() completes.
[[nodiscard]] bool is_hold(const stack::OperatorRequest& wanted);

/// Move to the positions at which the axes come to rest if they brake now: the axes of the accepted move, or,
/// without one, all axes of the crane.
/// @param reference_acceleration  of the planner, m/s² or rad/s²; 0: unknown; the target is then
///   the present position
[[nodiscard]] stack::OperatorRequest move_to_rest(const msg::State& state,
                                                  const msg::SupervisorStatus& status,
                                                  const std::array<double, 3>& reference_acceleration);

}  // namespace crane::dashboard
