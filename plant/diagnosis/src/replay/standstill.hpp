#pragma once
/// Standstill of an axis under dry friction.
#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

/// m/s or rad/s: a slower axis is at rest.
inline constexpr double kStandstillSpeed = 0.01;

/// m/s or rad/s: largest smoothing_speed of dry friction. Smoothed friction lets a pushed axis
/// creep where dry friction would hold it. A push of 0.95 of the friction gives 1.8 times this speed: 0.2 mm
/// in a window of 2 s. The smoothing_speed of simulations, 0.0005 m/s, would give 1.8 mm. With a smaller
/// value, the axis would creep less than one with elastic contacts (LuGre).
inline constexpr double kHoldingSpeed = 5e-5;

/// The crane with dry friction that holds a resting axis: each smoothing_speed is at most kHoldingSpeed.
[[nodiscard]] Crane holding(Crane crane);

}  // namespace crane::diagnosis
