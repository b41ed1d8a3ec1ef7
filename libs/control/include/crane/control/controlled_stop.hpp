#pragma once
/// Longest controlled stop.
namespace crane::control {

/// s: time after which the supervisor replaces a controlled stop by a ramped one (STOP_TIMEOUT,
/// docs/safety.md). A rig file must permit the voltage to return to 0 within this time.
inline constexpr double kControlledStop_s = 8;

}  // namespace crane::control
