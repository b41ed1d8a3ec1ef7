#pragma once
/// Trajectory planner: where each axis is to be at the next tick.
#include "crane/runtime/joined_component.hpp"
#include "crane/runtime/process.hpp"

namespace crane::services {

/// Joins crane/state and crane/supervisor; publishes crane/reference for the following tick, off the critical
/// path. While the crane is not held or run by the supervisor the reference is where the crane is, so that
/// arming never makes a step. A move begins when the supervisor has accepted its request.
[[nodiscard]] runtime::ComponentSpec trajectory_planner_spec();

}  // namespace crane::services
