#pragma once
/// Columns (sensor values) that the twin predicts: trolley [m], slew, radial and tangential swing [rad].
#include <array>
#include <cstddef>

#include "crane/stepper/kinematics.hpp"

namespace crane::twin {

inline constexpr std::size_t kColumns = stepper::kOutputs;
using PerColumn = std::array<double, kColumns>;
using Mask = std::array<bool, kColumns>;
[[nodiscard]] constexpr const plant::Coordinate& coordinate_of(std::size_t column) {
  return plant::kCoordinates.at(stepper::kCoordinateOf.at(column));
}

}  // namespace crane::twin
