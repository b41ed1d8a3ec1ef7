#pragma once
/// Limits of position, speed, stopping distance and swing.
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

struct EnvelopeInput {
  PerAxis position{};  ///< unit
  PerAxis speed{};     ///< unit/s
  double swing_radial_rad = 0;
  double swing_tangential_rad = 0;
  AxisFlags limit_low{}, limit_high{};  ///< limit switches
  double speed_share = 1;               ///< share of max_speed that the operating mode permits, (0, 1]
  /// True: the position has no known origin. Position limits do not apply, OVERSPEED begins at
  /// homing_overspeed_ratio times the homing speed, and a limit switch blocks voltage towards it.
  AxisFlags unknown{};
};

/// true: the limit is violated.
struct Envelope {
  /// true: positive voltage is blocked: the axis cannot stop before its high limit, or its high
  /// switch is pressed
  AxisFlags block_positive{};
  AxisFlags block_negative{};  ///< the same for the low limit and negative voltage
  bool stopping = false;       ///< an axis cannot stop before a hard limit: x +- (v t + v^2/2a)
  bool position = false;       ///< an axis is outside a hard limit
  bool limit_switch = false;
  bool overspeed = false;
  bool swing = false;          ///< above swing_limit_rad
  bool swing_runaway = false;  ///< above swing_limit_rad * swing_runaway_ratio
};

/// Ignores absent axes. A value that is not finite is a violation.
[[nodiscard]] Envelope check_envelope(const Limits& limits, const EnvelopeInput& input) noexcept;

}  // namespace crane::supervisor
