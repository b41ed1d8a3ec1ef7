#pragma once
/// Columns (sensor values) that the twin predicts: trolley [m], slew, radial and tangential swing [rad].
#include <array>
#include <cstddef>

#include "crane/diagnosis/data.hpp"

namespace crane::twin {

inline constexpr std::size_t kColumns = diagnosis::kOutputs;
using PerColumn = std::array<double, kColumns>;
using Mask = std::array<bool, kColumns>;
inline constexpr auto& kColumnNames = diagnosis::kOutputNames;
inline constexpr std::array<const char*, kColumns> kAxisNames{"trolley", "slew", "radial", "tangential"};
inline constexpr std::array<const char*, kColumns> kUnits{"m", "rad", "rad", "rad"};

}  // namespace crane::twin
