#pragma once
/// The twin as a process: reads crane/state, writes crane/twin, and writes crane/event when a deviation
/// begins or ends.
#include "crane/runtime/process.hpp"

namespace crane::twin {

/// The twin is not part of the control loop: no process of the loop reads its topic. A twin that is scheduled
/// late still takes every state in the order of the ticks. Consecutive missing ticks count as one gap.
[[nodiscard]] runtime::ComponentSpec twin_spec();

}  // namespace crane::twin
