#pragma once
/// Restart of the bridge while the supervisor runs. The new bridge sets its counters to [start] of the rig
/// file and its swing encoders to zero. These values are wrong if an axis was at another position or the load
/// was swinging. Therefore the supervisor compares them with the last samples of the old bridge.
#include "crane/supervisor/motion.hpp"

namespace crane::supervisor {

struct RestartMemory {
  AxisFlags doubtful{};              ///< true: the measured position of the axis may be wrong
  bool swing_zero_doubtful = false;  ///< true: the measured swing angles may be wrong
  bool watching = false;             ///< true: watch_load() checks the swing
  double since_s = 0;                ///< time of the last restart
};

/// The position of an axis is doubtful unless it was known, the old bridge showed the axis at rest, and
/// the new position agrees within brake_slip. The doubt ends with an accepted reset that confirms the
/// position, or when the bridge reports the position as unknown: then the axis must be homed. Another restart
/// does not end the doubt. Without a sample of an old bridge, no axis becomes doubtful.
/// @param before    motion measured with the old bridge
/// @param known     axes whose position was known with the old bridge
/// @param position  positions of the first sample of the new bridge; null: this sample is unusable
void take_over(const Limits& limits, double now_s, const MotionMemory& before, const AxisFlags& known,
               const PerAxis* position, RestartMemory& memory) noexcept;

/// A swing above load_still_rad within load_watch_s shows that the load was swinging when the new bridge set
/// its swing encoders to zero.
void watch_load(const Limits& limits, double now_s, double swing_radial_rad, double swing_tangential_rad,
                RestartMemory& memory) noexcept;

}  // namespace crane::supervisor
