#pragma once
/// Homing of an axis: a sequence of slow motions during which the bridge finds the position of the axis. Each
/// tick returns the speed of the reference; the planner integrates this speed, and the tracking law follows.
/// The demand is limited to volt_limit_v of [homing]; model checks and zones have no effect. The bridge
/// detects the mark (crane/bridge/homing.hpp).
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

enum class HomingPhase : std::uint8_t {
  leave_mark_first,  ///< away from the mark; only when the axis starts at its mark
  search,            ///< towards the mark at the homing speed, until the mark is active
  /// away from the mark, until the axis is `back_off` beyond the point at which the switch opened
  backing_off,
  approach,  ///< towards the mark at the approach speed, until the mark is active
  /// as backing_off; fails with mark_disagrees unless the bridge reports the mark as found within
  /// five ticks
  leave,
  done  ///< the axis has left the mark; the speed is 0. Then the bridge sets the position
};

struct HomingInput {
  double position = 0;        ///< unit; its origin is unknown
  bool mark_active = false;   ///< true: the axis is at its homing mark
  bool mark_found = false;    ///< true: the bridge has detected the mark twice at the same position
  bool other_switch = false;  ///< true: a limit switch that is not the homing mark is pressed
};

struct HomingMemory {
  HomingPhase phase = HomingPhase::leave_mark_first;
  HomingFailure failure = HomingFailure::none;
  bool started = false;
  /// true: in an earlier tick, no limit switch other than the homing mark was pressed
  bool other_left = false;
  int ticks = 0;           ///< number of ticks in this phase
  int still_ticks = 0;     ///< number of ticks without progress
  double from = 0;         ///< position at the start of this phase
  double opened_at = 0;    ///< last position at which the mark was active
  double progress_at = 0;  ///< position at the last progress
};

/// Advances homing by one tick. @return speed of the reference, unit/s; 0 when done or failed
double step_homing(const Limits& limits, std::size_t axis, const HomingInput& input,
                   HomingMemory& memory) noexcept;

}  // namespace crane::supervisor
