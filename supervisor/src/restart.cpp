#include "crane/supervisor/restart.hpp"

#include <cmath>

namespace crane::supervisor {

void take_over(const Limits& limits, double now_s, const MotionMemory& before, const AxisFlags& known,
               const PerAxis* position, RestartMemory& memory) noexcept {
  memory.swing_zero_doubtful = false;
  memory.watching = true;
  memory.since_s = now_s;
  if (!before.started) return;
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!limits.axis[i].present) continue;
    const bool rested = before.arrived_s - before.window_since_s[i] >= limits.standstill_time_s;
    const bool there =
        position != nullptr && std::abs((*position)[i] - before.position[i]) <= limits.axis[i].brake_slip;
    if (!known[i] || !rested || !there) memory.doubtful[i] = true;
  }
}

void watch_load(const Limits& limits, double now_s, double swing_radial_rad, double swing_tangential_rad,
                RestartMemory& memory) noexcept {
  if (!memory.watching || now_s - memory.since_s > limits.load_watch_s) return;
  const bool still = std::abs(swing_radial_rad) <= limits.load_still_rad &&
                     std::abs(swing_tangential_rad) <= limits.load_still_rad;
  if (!still) memory.swing_zero_doubtful = true;
}

}  // namespace crane::supervisor
