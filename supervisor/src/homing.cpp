#include "crane/supervisor/homing.hpp"

#include <algorithm>
#include <cmath>

namespace crane::supervisor {
namespace {

using control::Mark;

constexpr double kMargin = 1.1;  // longest search / travel of the axis: 10 % for an error of the scale
constexpr double kStill_s = 1;   // longest time without progress
// Smallest progress within kStill_s / commanded distance. Far below 1: static friction delays the
// start.
constexpr double kShareOfSpeed = 0.005;
constexpr double kLongestLeg = 4;      // longest leg near the mark / back_off
constexpr double kWrongDirection = 2;  // longest motion in the wrong direction (reversal) / back_off
// longest time in `leave` until the bridge reports the mark as found
constexpr int kTicksToBeFound = 5;

struct Leg {
  double direction = 0, speed = 0;
  double longest = 0;  // longest distance, unit
  HomingFailure too_long = HomingFailure::none;
};

Leg leg_of(const AxisLimits& axis, HomingPhase phase) {
  const auto& homing = axis.homing;
  const double travel = kMargin * (axis.high_limit - axis.low_limit);
  const double back = kLongestLeg * homing.back_off;
  const double to_mark = homing.direction();
  switch (phase) {
    case HomingPhase::leave_mark_first:
      // A separate mark is active over a part of the travel, which can be long.
      return {-to_mark, homing.speed, homing.mark == Mark::input ? travel : back, HomingFailure::mark_stuck};
    case HomingPhase::search:
      return {to_mark, homing.speed, travel, HomingFailure::mark_not_found};
    case HomingPhase::backing_off:
    case HomingPhase::leave:
      return {-to_mark, homing.speed, back, HomingFailure::mark_stuck};
    case HomingPhase::approach:
      return {to_mark, homing.approach_speed, back, HomingFailure::mark_not_found};
    case HomingPhase::done:
      break;
  }
  return {};
}

void begin(HomingPhase phase, const HomingInput& in, HomingMemory& m) {
  m.phase = phase;
  m.ticks = m.still_ticks = 0;
  m.from = m.opened_at = m.progress_at = in.position;
}

/// True when the axis is `back_off` beyond the position at which the switch opened.
bool off_the_mark(const AxisLimits& axis, const Leg& leg, const HomingInput& in, HomingMemory& m) {
  if (in.mark_active) m.opened_at = in.position;
  return !in.mark_active && leg.direction * (in.position - m.opened_at) >= axis.homing.back_off;
}

void advance(const AxisLimits& axis, const Leg& leg, const HomingInput& in, HomingMemory& m) {
  switch (m.phase) {
    case HomingPhase::leave_mark_first:
      if (off_the_mark(axis, leg, in, m)) begin(HomingPhase::search, in, m);
      return;
    case HomingPhase::search:
      if (in.mark_active) begin(HomingPhase::backing_off, in, m);
      return;
    case HomingPhase::backing_off:
      if (off_the_mark(axis, leg, in, m)) begin(HomingPhase::approach, in, m);
      return;
    case HomingPhase::approach:
      if (in.mark_active) begin(HomingPhase::leave, in, m);
      return;
    case HomingPhase::leave:
      if (m.ticks >= kTicksToBeFound && !in.mark_found)
        m.failure = HomingFailure::mark_disagrees;
      else if (in.mark_found && off_the_mark(axis, leg, in, m))
        begin(HomingPhase::done, in, m);
      return;
    case HomingPhase::done:
      return;
  }
}

HomingFailure failure_of(const Limits& limits, const AxisLimits& axis, const Leg& leg, const HomingInput& in,
                         HomingMemory& m) {
  m.other_left = m.other_left || !in.other_switch;
  const double moved = leg.direction * (in.position - m.from);
  const double least = kShareOfSpeed * leg.speed * kStill_s;
  if (std::abs(in.position - m.progress_at) >= least) {
    m.progress_at = in.position;
    m.still_ticks = 0;
  }
  const bool still = ++m.still_ticks * limits.period_s > kStill_s;
  const double back = kLongestLeg * axis.homing.back_off;
  if (in.mark_active && in.other_switch && axis.homing.mark != Mark::input) return HomingFailure::mark_stuck;
  if (in.other_switch && (m.other_left || moved > back)) return HomingFailure::other_switch;
  if (moved > leg.longest) return leg.too_long;
  const bool wrong_direction = moved < -kWrongDirection * axis.homing.back_off;
  return still || wrong_direction ? HomingFailure::no_motion : HomingFailure::none;
}

}  // namespace

double step_homing(const Limits& limits, std::size_t i, const HomingInput& in, HomingMemory& m) noexcept {
  const AxisLimits& axis = limits.axis[i];
  if (!m.started) {
    m.started = true;
    begin(in.mark_active ? HomingPhase::leave_mark_first : HomingPhase::search, in, m);
  }
  if (m.phase == HomingPhase::done || m.failure != HomingFailure::none) return 0;
  m.failure = failure_of(limits, axis, leg_of(axis, m.phase), in, m);
  ++m.ticks;
  if (m.failure == HomingFailure::none) advance(axis, leg_of(axis, m.phase), in, m);
  if (m.failure != HomingFailure::none || m.phase == HomingPhase::done) return 0;
  const Leg leg = leg_of(axis, m.phase);
  return leg.direction * leg.speed;
}

}  // namespace crane::supervisor
