#pragma once
/// Speeds and standstill, computed from the positions only. The filters of the bridge have no effect.
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

struct MotionMemory {
  bool started = false;
  double sampled_s = 0;       ///< time at which `position` was latched, clock of the bridge
  double arrived_s = 0;       ///< time at which `position` arrived, clock of the supervisor
  PerAxis position{};         ///< newest sample, unit
  PerAxis speed{};            ///< backward difference of the two newest samples, unit/s
  PerAxis window_position{};  ///< middle of the window that the axis has not left
  PerAxis window_since_s{};   ///< time since which the axis is inside the window
};

/// Takes the positions of one tick. The speed is the difference of the positions divided by the difference of
/// the sample times, so that late ticks do not distort it. A sample that is not newer is ignored.
void observe(const Limits& limits, double now_s, double sampled_s, const PerAxis& position,
             MotionMemory& memory) noexcept;

/// True when every present axis has stayed within standstill_speed * standstill_time_s of one position for
/// standstill_time_s.
[[nodiscard]] bool standstill(const Limits& limits, double now_s, const MotionMemory& memory) noexcept;

/// Motion at the tick at which the brakes were commanded closed.
struct BrakeMemory {
  bool valid = false;  ///< true: the following fields are valid
  double since_s = 0;  ///< time of this tick, clock of the supervisor
  PerAxis position{};  ///< unit
  PerAxis speed{};     ///< unit/s
};

/// Call when homing has set the present position of the axis to `position`, before the first sample with the
/// new position.
void set_homed_position(std::size_t axis, double position, MotionMemory& motion,
                        BrakeMemory& brakes) noexcept;

/// Call at every tick with a sample while the brakes are commanded closed. The first call stores position and
/// speed.
/// @return true when a brake has not closed: an axis has moved farther than twice its stopping distance plus
///   brake_slip, or its brake does not report closed in time
[[nodiscard]] bool brake_did_not_close(const Limits& limits, double now_s, const MotionMemory& motion,
                                       const AxisFlags& brake_closed, BrakeMemory& memory) noexcept;

/// Start of the time without watchdog permission.
struct RelayMemory {
  bool withheld = false;  ///< true: `since_s` is valid
  double since_s = 0;     ///< time of the first tick without permission, clock of the supervisor
};

/// Call at every tick with a sample while the watchdog permission is withheld.
/// @return true when the relay still reports closed although it must have opened: its contacts are welded
[[nodiscard]] bool relay_did_not_open(const Limits& limits, double now_s, bool relay_closed,
                                      RelayMemory& memory) noexcept;

}  // namespace crane::supervisor
