#include "crane/bridge/start_counts.hpp"

#include <cmath>

namespace crane::bridge {

std::array<std::int64_t, kCounters> start_counts(const configuration::Rig& rig) {
  std::array<double, kCounters> start{rig.start.position[0], rig.start.position[1], rig.start.position[2],
                                      rig.start.swing_radial_rad, rig.start.swing_tangential_rad};
  for (std::size_t i = 0; i < kDrives; ++i)
    if (rig.drives[i].homes()) start[i] = rig.drives[i].unhomed_position();
  std::array<std::int64_t, kCounters> counts{};
  for (std::size_t i = 0; i < kCounters; ++i)
    counts[i] = std::llround(rig.encoders[i].sign * (start[i] + rig.encoders[i].rest_angle_rad) *
                             rig.encoders[i].counts_per_unit);
  return counts;
}

}  // namespace crane::bridge
