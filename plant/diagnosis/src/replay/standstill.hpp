#pragma once
namespace crane::diagnosis {

/// Slower than this [m/s or rad/s], an axis with friction stands.
inline constexpr double kStandstillSpeed = 0.01;

}  // namespace crane::diagnosis
