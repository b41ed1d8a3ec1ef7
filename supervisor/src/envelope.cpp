#include "crane/supervisor/envelope.hpp"

#include <cmath>

namespace crane::supervisor {

// Every comparison treats NaN as a violation.
Envelope check_envelope(const Limits& limits, const EnvelopeInput& input) noexcept {
  Envelope found;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const AxisLimits& axis = limits.axis[i];
    if (!axis.present) continue;
    const double x = input.position[i];
    const double v = input.speed[i];
    if (input.unknown[i]) {
      found.block_positive[i] = input.limit_high[i];
      found.block_negative[i] = input.limit_low[i];
      found.overspeed =
          found.overspeed || !(std::abs(v) <= limits.homing_overspeed_ratio * axis.homing.speed);
      continue;
    }
    const double distance = stopping_distance(limits, i, v);
    const double ahead = v > 0 ? x + distance : x;
    const double behind = v < 0 ? x - distance : x;
    found.block_positive[i] = !(ahead <= axis.high_limit) || input.limit_high[i];
    found.block_negative[i] = !(behind >= axis.low_limit) || input.limit_low[i];
    found.stopping = found.stopping || !(ahead <= axis.high_limit) || !(behind >= axis.low_limit);
    found.position = found.position || !(x <= axis.high_limit && x >= axis.low_limit);
    found.limit_switch = found.limit_switch || input.limit_low[i] || input.limit_high[i];
    found.overspeed = found.overspeed || !(std::abs(v) <= input.speed_share * axis.max_speed);
  }
  const auto beyond = [&input](double limit_rad) {
    return !(std::abs(input.swing_radial_rad) <= limit_rad &&
             std::abs(input.swing_tangential_rad) <= limit_rad);
  };
  found.swing = beyond(limits.swing_limit_rad);
  found.swing_runaway = beyond(limits.swing_limit_rad * limits.swing_runaway_ratio);
  return found;
}

}  // namespace crane::supervisor
