#pragma once
/// Motion of a drive by row, from its measured position and its command.
#include <cstddef>
#include <vector>

#include "crane/diagnosis/replay.hpp"
#include "noise/disturbance.hpp"

namespace crane::diagnosis {

/// @param drive trolley or slew, measured and commanded
/// @param first,rows of the window
[[nodiscard]] MotionProfile motion_profile_of(const PreparedRun& run, Output drive, std::size_t first,
                                              std::size_t rows);

}  // namespace crane::diagnosis
