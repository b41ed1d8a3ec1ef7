#pragma once
/// A bridge that has started anew beside a running supervisor. Its counters begin where [start] of the rig
/// file says, and its swing encoders where the load hangs: both are believed only as far as they have been
/// seen.
#include "crane/supervisor/motion.hpp"

namespace crane::supervisor {

struct RestartMemory {
  AxisFlags doubted{};        ///< where the axis stands is unclear
  bool load_doubted = false;  ///< where the load hangs is unclear
  bool watching = false;      ///< whether the load hangs still
  double since_s = 0;         ///< of the newest start
};

/// @param before    what was seen of the old bridge
/// @param known     axes that had a zero with the old bridge
/// @param position  of the first sample of the new one; null: it cannot be used
/// An axis is in doubt unless it was at rest when last seen, and is there still, within brake_slip. Doubt
/// outlives a further start: only an operator's word, or homing, ends it.
void take_over(const Limits& limits, double now_s, const MotionMemory& before, const AxisFlags& known,
               const PerAxis* position, RestartMemory& memory) noexcept;

/// A load that moves soon after the start did not hang at zero when the start called it zero.
void watch_load(const Limits& limits, double now_s, double swing_radial_rad, double swing_tangential_rad,
                RestartMemory& memory) noexcept;

}  // namespace crane::supervisor
