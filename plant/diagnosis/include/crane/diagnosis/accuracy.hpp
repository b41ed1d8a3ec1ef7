#pragma once
/// Accuracy of a rig file: errors of this size are not worth a name.

namespace crane::diagnosis {

struct Accuracy {
  double values = 0;         ///< of gains, lengths, masses and scales, share of the value, >= 0
  double friction = 0;       ///< of the friction of a drive, share of its Coulomb and viscous friction, >= 0
  double times_periods = 0;  ///< of delays and lags, control periods, >= 0
};

/// Lengths and gains are measured to a percent or two. The friction of a drive changes by a few percent with
/// its temperature. A process delays a command by up to one period, by half of it on average.
inline constexpr Accuracy kUsualAccuracy{.values = 0.02, .friction = 0.05, .times_periods = 0.5};

}  // namespace crane::diagnosis
