#pragma once
/// Degrees, for files and displays. All computation is in radians.
#include <numbers>

namespace crane::fields {

inline constexpr double kRadPerDeg = std::numbers::pi / 180;
inline constexpr double kDegPerRad = 180 / std::numbers::pi;

}  // namespace crane::fields
