#pragma once
/// Motion phases of an axis from its measured position.
#include <cstddef>
#include <vector>

#include "noise/disturbance.hpp"

namespace crane::diagnosis {

/// @param position of a whole run, m or rad
/// @param first,rows of the window
[[nodiscard]] MotionProfile motion_profile_of(const std::vector<double>& position, double period_s,
                                              std::size_t first, std::size_t rows);

}  // namespace crane::diagnosis
