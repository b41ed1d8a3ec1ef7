#pragma once
/// The twin as a process: reads crane/state, writes crane/twin, and crane/event when the residual leaves its
/// band.
#include "crane/runtime/process.hpp"

namespace crane::twin {

/// The twin is not part of the control loop: no process of the loop reads its topic. It takes every state in
/// the order of the ticks, even when it is scheduled late, and counts missing ticks as gaps.
[[nodiscard]] runtime::ComponentSpec twin_spec();

}  // namespace crane::twin
