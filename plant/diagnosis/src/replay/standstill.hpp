#pragma once
namespace crane::diagnosis {

/// m/s or rad/s: a slower axis is at rest.
inline constexpr double kStandstillSpeed = 0.01;

}  // namespace crane::diagnosis
