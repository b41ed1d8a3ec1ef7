#pragma once
/// The sample of a tick in the memory of the supervisor.
#include "crane/supervisor/supervisor.hpp"

namespace crane::supervisor {

/// If the bridge has restarted, removes the samples of the old bridge from all checks, and marks the
/// positions that the operator must confirm (restart.hpp).
void take_over_bridge(const Limits& limits, const TickInput& input, TickMemory& memory);

/// Stores the sample, and counts missing and late samples.
/// @return true when a usable sample has arrived in this tick
bool take_sample(const Limits& limits, const TickInput& input, TickMemory& memory);

}  // namespace crane::supervisor
