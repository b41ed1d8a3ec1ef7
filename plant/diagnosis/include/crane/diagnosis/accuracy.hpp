#pragma once
/// Accuracy of a rig file: errors within this accuracy are not named as causes.

namespace crane::diagnosis {

struct Accuracy {
  double values = 0;         ///< error of gains, lengths, masses and scales / value, >= 0
  double friction = 0;       ///< error of the Coulomb and viscous friction of a drive / value, >= 0
  double times_periods = 0;  ///< error of delays and lags, control periods, >= 0
};

/// Lengths and gains are measured to a percent or two. The friction of a drive changes by a few percent with
/// its temperature. A process delays a command by up to one period, on average by half a period.
inline constexpr Accuracy kUsualAccuracy{.values = 0.02, .friction = 0.05, .times_periods = 0.5};

/// Share of a motion that an unknown disturbance may change: Accuracy::values, or the usual accuracy if the
/// rig file is stated to be exact (0).
[[nodiscard]] constexpr double permitted_share(const Accuracy& accuracy) {
  return accuracy.values > 0 ? accuracy.values : kUsualAccuracy.values;
}

}  // namespace crane::diagnosis
