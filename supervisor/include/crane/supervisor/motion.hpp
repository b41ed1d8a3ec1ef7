#pragma once
/// Speeds and standstill from the positions alone, independent of the speeds and filters of the bridge.
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

struct MotionMemory {
  bool started = false;
  double sampled_s = 0;       ///< when `position` was latched, by the clock of the bridge
  double seen_s = 0;          ///< when it was seen, by the supervisor's clock
  PerAxis position{};         ///< newest sample, unit
  PerAxis speed{};            ///< backward difference of the two newest samples, unit/s
  PerAxis window_position{};  ///< middle of the window the axis has not left since ...
  PerAxis window_since_s{};   ///< ... this time
};

/// Takes the positions of one tick. A speed is the way over the time between the two samples, however late a
/// tick was. A sample of the same or an earlier time is ignored.
void observe(const Limits& limits, double now_s, double sampled_s, const PerAxis& position,
             MotionMemory& memory) noexcept;

/// Every present axis has stayed within standstill_speed * standstill_time_s for standstill_time_s.
[[nodiscard]] bool standstill(const Limits& limits, double now_s, const MotionMemory& memory) noexcept;

/// What has happened since the brakes were told to close.
struct BrakeMemory {
  bool anchored = false;  ///< the fields below are valid
  double since_s = 0;
  PerAxis position{};
  PerAxis speed{};
};

/// The same place is called `position` from now on: the axis has been homed. To be called before the sample
/// that shows it first is taken.
void rename_place(std::size_t axis, double position, MotionMemory& motion, BrakeMemory& brakes) noexcept;

/// Call once a tick in which a sample arrived while the brakes are told to close. The first such tick sets
/// the anchor; afterwards
/// @return true when a brake has not closed: an axis is farther from its anchor than twice its braking
/// distance
///         plus brake_slip, or its brake does not report closed in time
[[nodiscard]] bool brake_failed(const Limits& limits, double now_s, const MotionMemory& motion,
                                const AxisFlags& brake_closed, BrakeMemory& memory) noexcept;

}  // namespace crane::supervisor
