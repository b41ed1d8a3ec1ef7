#pragma once
/// Bounds of a ramped stop that begins in the next tick: steps 1 to 4 of crane/supervisor/zone_filter.hpp.
#include <algorithm>
#include <cmath>

#include "crane/supervisor/zone_filter.hpp"

namespace crane::supervisor {

/// Position over the ground.
[[nodiscard]] inline ZoneMemory::Plane polar(double radius_m, double angle_rad) noexcept {
  return {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad)};
}

/// Travel of one axis until standstill, upwards and downwards, and its largest speed meanwhile.
struct StopTravel {
  double up = 0, down = 0, speed = 0, duration_s = 0;
  [[nodiscard]] double longest() const { return std::max(up, down); }
};

/// Motion of the load at the newest sample.
struct LoadMotion {
  double shortest_m = 0, longest_m = 0;  ///< true cable length
  double swing = 0;                      ///< sine of the angle between cable and vertical
  double speed_mps = 0;
};

/// Sector in which the suspension point stops, and the disc that covers it.
struct StopRegion {
  double middle_m = 0, middle_rad = 0;  ///< centre, trolley and slew
  ZoneMemory::Plane centre{};           ///< the same over the ground
  double radius_m = 0;                  ///< rho
};
/// Bounds of steps 1 to 3.
struct RampedStop {
  LoadMotion load;
  StopTravel trolley, slew;
  StopRegion region;
  double swing_m = 0;  ///< A
};

[[nodiscard]] RampedStop ramped_stop(const Limits& limits, const ZoneInput& input,
                                     const ZoneMemory& memory) noexcept;

/// Step 4.
[[nodiscard]] control::ReachedSpace reach_of(const Limits& limits, const RampedStop& stop) noexcept;

}  // namespace crane::supervisor
