#pragma once
/// The process of the trajectory planner: computes the reference of each axis for the next tick.
#include "crane/runtime/joined_component.hpp"
#include "crane/runtime/process.hpp"

namespace crane::services {

/// Joins crane/state and crane/supervisor; publishes crane/reference for the following tick, outside the
/// critical path. HOLD and RUN: moves, homing and the stick determine the reference. STOP_C1: the
/// reference decelerates to rest. Every other state: the reference is the measured position, so
/// that arming causes no step. A move begins when the supervisor has accepted its request.
[[nodiscard]] runtime::ComponentSpec trajectory_planner_spec();

}  // namespace crane::services
