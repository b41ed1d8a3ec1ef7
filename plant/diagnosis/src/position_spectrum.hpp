#pragma once
/// Waves over position in a drive's unexplained acceleration.
#include <vector>

#include "crane/diagnosis/replay.hpp"
#include "crane/runtime/rig.hpp"

namespace crane::diagnosis {

/// amplitude * sin(2 pi position / period + phase_rad), in m/s2 or rad/s2.
struct PositionWave {
  double period = 0, amplitude = 0, phase_rad = 0;
};

/// Peaks of the least-squares spectrum over position of (measured acceleration - model's), strongest first.
[[nodiscard]] std::vector<PositionWave> strongest_waves(const runtime::Rig& rig,
                                                        const std::vector<PreparedRun>& runs, Output axis,
                                                        std::size_t count);

}  // namespace crane::diagnosis
