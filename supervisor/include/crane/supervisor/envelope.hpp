#pragma once
/// Where the crane may be, how fast, and how far its load may swing.
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

struct EnvelopeInput {
  PerAxis position{};  ///< unit
  PerAxis speed{};     ///< unit/s
  double swing_radial_rad = 0;
  double swing_tangential_rad = 0;
  AxisFlags limit_low{}, limit_high{};  ///< limit switches
  AxisFlags unknown{};  ///< the axis has no zero: where it is, is not judged, but how fast it creeps
};

/// false = healthy
struct Envelope {
  AxisFlags block_positive{};  ///< no positive voltage on this axis: it would not stop before its high limit
  AxisFlags block_negative{};  ///< the same downwards
  bool stopping = false;       ///< x +- v t +- v^2/2a of some axis lies outside a hard limit
  bool position = false;       ///< some axis is outside a hard limit
  bool limit_switch = false;
  bool overspeed = false;
  bool swing = false;          ///< above swing_limit_rad
  bool swing_runaway = false;  ///< above swing_limit_rad * swing_runaway_ratio
};

/// Absent axes are not judged. A value that is not finite counts as a violation.
[[nodiscard]] Envelope check_envelope(const Limits& limits, const EnvelopeInput& input) noexcept;

}  // namespace crane::supervisor
