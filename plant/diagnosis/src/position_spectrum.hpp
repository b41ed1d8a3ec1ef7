#pragma once
/// Periods in position at which a drive's unexplained acceleration repeats.
#include <vector>

#include "crane/diagnosis/replay.hpp"
#include "crane/runtime/rig.hpp"

namespace crane::diagnosis {

/// Peaks of the least-squares spectrum over position of (measured acceleration - model's), strongest first.
[[nodiscard]] std::vector<double> strongest_periods(const runtime::Rig& rig,
                                                    const std::vector<PreparedRun>& runs, Output axis,
                                                    std::size_t count);

}  // namespace crane::diagnosis
