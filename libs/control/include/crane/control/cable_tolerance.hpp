#pragma once
/// Error of the measured cable length that the check of the swing encoders tolerates.

namespace crane::control {

/// Relative error of the cable length: 0.5 (true length 0.5 to 1.5 times the measured one) x 1.1.
inline constexpr double kCableTolerance = 0.55;

}  // namespace crane::control
