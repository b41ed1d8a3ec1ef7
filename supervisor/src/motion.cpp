#include "crane/supervisor/motion.hpp"

#include <algorithm>
#include <cmath>

#include "crane/protection.hpp"

namespace crane::supervisor {

void observe(const Limits& limits, double now_s, double sampled_s, const PerAxis& position,
             MotionMemory& memory) noexcept {
  if (memory.started && !(sampled_s > memory.sampled_s)) return;
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (memory.started) memory.speed[i] = (position[i] - memory.position[i]) / (sampled_s - memory.sampled_s);
    const double window = limits.axis[i].standstill_speed * limits.standstill_time_s;
    if (!memory.started || std::abs(position[i] - memory.window_position[i]) > window) {
      memory.window_position[i] = position[i];
      memory.window_since_s[i] = now_s;
    }
  }
  memory.position = position;
  memory.sampled_s = sampled_s;
  memory.arrived_s = now_s;
  memory.started = true;
}

bool standstill(const Limits& limits, double now_s, const MotionMemory& memory) noexcept {
  if (!memory.started) return false;
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (limits.axis[i].present && now_s - memory.window_since_s[i] < limits.standstill_time_s) return false;
  }
  return true;
}

void set_homed_position(std::size_t axis, double position, MotionMemory& motion,
                        BrakeMemory& brakes) noexcept {
  const double change = position - motion.position[axis];
  for (double* place : {&motion.position[axis], &motion.window_position[axis], &brakes.position[axis]})
    *place += change;
}

bool brake_did_not_close(const Limits& limits, double now_s, const MotionMemory& motion,
                         const AxisFlags& brake_closed, BrakeMemory& memory) noexcept {
  if (!memory.valid) {
    memory = {.valid = true, .since_s = now_s, .position = motion.position, .speed = motion.speed};
    return false;
  }
  bool failed = false;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const AxisLimits& axis = limits.axis[i];
    if (!axis.present) continue;
    // Twice the stopping distance: the axis may have accelerated when the brakes were commanded closed.
    const double allowed = 2 * stopping_distance(limits, i, memory.speed[i]) + axis.brake_slip;
    const bool slipped = std::abs(motion.position[i] - memory.position[i]) > allowed;
    const double report_s = limits.period_s + axis.brake_close_time_s + limits.brake_report_time_s;
    const bool silent = !brake_closed[i] && now_s - memory.since_s > report_s;
    using enum protection::Protection;
    failed = failed || (slipped && protection::enabled(brake_slip)) ||
             (silent && protection::enabled(brake_report));
  }
  return failed;
}

bool relay_did_not_open(const Limits& limits, double now_s, bool relay_closed, RelayMemory& memory) noexcept {
  if (!memory.withheld) {
    memory = {.withheld = true, .since_s = now_s};
    return false;
  }
  const double report_s = limits.period_s + limits.relay_timeout_s + limits.relay_report_time_s;
  return relay_closed && now_s - memory.since_s > report_s;
}

}  // namespace crane::supervisor
