#pragma once
/// Columns (sensor values) that the twin predicts: trolley [m], slew, radial and tangential swing [rad].
#include <array>
#include <cstddef>

#include "crane/diagnosis/data.hpp"

namespace crane::twin {

inline constexpr std::size_t kColumns = diagnosis::kOutputs;
using PerColumn = std::array<double, kColumns>;
using Mask = std::array<bool, kColumns>;
[[nodiscard]] constexpr const plant::Coordinate& coordinate_of(std::size_t column) {
  return plant::kCoordinates.at(diagnosis::kCoordinateOf.at(column));
}

}  // namespace crane::twin
