#pragma once
/// The move that the supervisor has accepted, as the planner uses it.
#include "crane/control/excitation.hpp"
#include "crane/topics.hpp"
#include "trajectory_planner/profile_limits.hpp"

namespace crane::services {

[[nodiscard]] MoveTarget target_of(const msg::AcceptedMove& request);

/// @pre exactly one axis is selected; the supervisor checks this
[[nodiscard]] control::Excitation excitation_of(const msg::AcceptedMove& request);

/// Whether all targets of a move are finite and inside the limits of their drives. The supervisor accepts no
/// other move: another target was changed on its way.
[[nodiscard]] bool is_inside_limits(const configuration::Rig& rig, const msg::AcceptedMove& move);

}  // namespace crane::services
