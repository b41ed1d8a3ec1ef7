#pragma once
/// How an axis without a zero creeps to its mark: away from it if it stands on it, then towards it, back,
/// and towards it again slowly, for that is the sight that counts; then off the mark, and done. It gives the
/// speed of the reference; the planner and the controllers follow it, through the gate, as in any move. The
/// bridge sees the mark by itself (crane/bridge/homing.hpp).
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

enum class HomingPhase : std::uint8_t {
  leave_at_first,  ///< it stands on its mark, or on the limit switch of the other end
  search,
  back_off,
  approach,
  leave,
  done
};

struct HomingInput {
  double position = 0;       ///< unit; its origin is unknown
  bool mark_active = false;  ///< the axis is at its homing mark
  bool mark_found = false;   ///< the bridge has seen the mark twice at the same place
  bool other_switch =
      false;  ///< the limit switch at the end that the mark is not at; both, for a mark of its own
};

struct HomingMemory {
  HomingPhase phase = HomingPhase::leave_at_first;
  HomingFailure failure = HomingFailure::none;
  bool started = false;
  bool other_left = false;  ///< the switch of the other end has been open
  int ticks = 0;            ///< in this phase
  int still_ticks = 0;      ///< since the axis was last seen to get on
  double from = 0;          ///< position at the beginning of this phase
  double opened_at = 0;     ///< where the mark's switch was seen closed last
  double seen_at = 0;       ///< where the axis was when it was last seen to get on
};

/// One tick. @return the speed that the reference is to have, unit/s; 0 when done or failed
double step_homing(const Limits& limits, std::size_t axis, const HomingInput& input,
                   HomingMemory& memory) noexcept;

}  // namespace crane::supervisor
