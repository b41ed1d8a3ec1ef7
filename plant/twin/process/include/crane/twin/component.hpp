#pragma once
/// The twin on the bus: crane/state in, crane/twin out, crane/event when the residual leaves its band.
#include "crane/runtime/process.hpp"

namespace crane::twin {

/// Off the critical path: nobody in the loop reads what it publishes. It takes every state in the order of
/// the ticks, however late it is scheduled, and counts those that are missing as gaps.
[[nodiscard]] runtime::ComponentSpec twin_spec();

}  // namespace crane::twin
