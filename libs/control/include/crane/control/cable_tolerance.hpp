#pragma once
/// Error of the measured cable length that the check of the swing encoders tolerates.

namespace crane::control {

/// Largest |true - measured| / measured cable length: 0.5, with a margin of 10 %.
inline constexpr double kCableTolerance = 0.55;

}  // namespace crane::control
