#include "crane/supervisor/supervisor.hpp"

namespace crane::supervisor {

FollowingInput following_input(const Sample& sample, const AxisFlags& free) noexcept {
  return {.sampled_s = sample.time_s,
          .position = sample.position,
          .swing_radial_rad = sample.swing_radial_rad,
          .swing_tangential_rad = sample.swing_tangential_rad,
          .applied_v = sample.applied_v,
          .free = free};
}

PendulumInput pendulum_input(const Sample& sample) noexcept {
  return {.sampled_s = sample.time_s,
          .position = sample.position,
          .radial_rad = sample.swing_radial_rad,
          .tangential_rad = sample.swing_tangential_rad};
}

ZoneInput zone_input(const TickMemory& memory, const PerAxis& gate_output_v) noexcept {
  return {.sampled_s = memory.motion.sampled_s,
          .position = memory.motion.position,
          .speed = memory.motion.speed,
          .swing_radial_rad = memory.sample.swing_radial_rad,
          .swing_tangential_rad = memory.sample.swing_tangential_rad,
          .applied_v = memory.sample.applied_v,
          .gate_output_v = gate_output_v,
          .missing_ticks = memory.state_missing_in_row};
}

}  // namespace crane::supervisor
