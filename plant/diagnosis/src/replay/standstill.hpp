#pragma once
/// Standstill of an axis under dry friction.
#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

/// m/s or rad/s: a slower axis is at rest.
inline constexpr double kStandstillSpeed = 0.01;

/// m/s or rad/s: largest smoothing_speed of dry friction. Smoothed friction lets a pushed axis
/// creep where dry friction holds it: with 0.95 of the friction, 1.8 times this speed, which is 0.2 mm in a
/// window of 2 s; the 0.0005 m/s of simulations are 1.8 mm. A smaller value holds harder than friction with
/// elastic contacts (LuGre) does.
inline constexpr double kHoldingSpeed = 5e-5;

/// The crane with dry friction that holds a resting axis: each smoothing_speed is at most kHoldingSpeed.
[[nodiscard]] Crane holding(Crane crane);

}  // namespace crane::diagnosis
