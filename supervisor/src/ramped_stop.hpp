#pragma once
/// Bounds of the motion during a ramped stop that begins in the next tick. Steps and symbols are those of
/// docs/zones.md#the-filter.
#include <algorithm>
#include <cmath>

#include "crane/supervisor/zone_filter.hpp"

namespace crane::supervisor {

/// Horizontal position over the ground, m, of a point on the jib.
[[nodiscard]] inline ZoneMemory::Plane polar(double radius_m, double angle_rad) noexcept {
  return {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad)};
}

/// Step 1: one axis until standstill. Units of the axis: m or rad.
struct StopTravel {
  double up = 0, down = 0;  ///< D: largest travel in positive and in negative direction
  double speed = 0;         ///< v_most: largest speed
  double duration_s = 0;    ///< longest time until standstill
  [[nodiscard]] double longest() const { return std::max(up, down); }
};

/// Cable length until standstill, and motion of the load at the newest sample.
struct LoadMotion {
  double shortest_m = 0, longest_m = 0;  ///< bounds of the true cable length L
  double swing = 0;                      ///< sine of the angle between cable and vertical
  double speed_mps = 0;                  ///< w: upper bound
};

/// Step 2: disc that covers the sector in which the suspension point stops.
struct StopRegion {
  double middle_m = 0, middle_rad = 0;  ///< centre of the disc: trolley position, slew angle
  ZoneMemory::Plane centre{};           ///< the same centre over the ground, m
  double radius_m = 0;                  ///< rho
};

/// Results of steps 1 to 3.
struct RampedStop {
  LoadMotion load;
  StopTravel trolley, slew;
  StopRegion region;
  double swing_m = 0;  ///< A of step 3: largest horizontal distance between load and suspension point
};

[[nodiscard]] RampedStop ramped_stop(const Limits& limits, const ZoneInput& input,
                                     const ZoneMemory& memory) noexcept;

/// Step 4: space that load, hook and cable can reach.
[[nodiscard]] control::ReachedSpace reached_space_of(const Limits& limits, const RampedStop& stop) noexcept;

}  // namespace crane::supervisor
