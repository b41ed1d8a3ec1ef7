#include "crane/control/zone.hpp"

#include <algorithm>
#include <cmath>

namespace crane::control {
namespace {

/// Signed distance of a point from the outline of the zone, m; negative inside.
double outline_distance_m(const Zone& zone, double x_m, double y_m) noexcept {
  const double dx = x_m - zone.position_x_m, dy = y_m - zone.position_y_m;
  if (zone.shape == ZoneShape::cylinder) return std::hypot(dx, dy) - zone.radius_m;
  const double beyond_x = std::abs(dx) - zone.size_x_m / 2, beyond_y = std::abs(dy) - zone.size_y_m / 2;
  const double outside = std::hypot(std::max(beyond_x, 0.0), std::max(beyond_y, 0.0));
  return outside + std::min(std::max(beyond_x, beyond_y), 0.0);
}

constexpr int kMostSteps = 2000;
constexpr double kStep_m = 0.005;  // distance between two checked points of a path
constexpr double kRounding_m = 1e-9;

int steps_of(const plant::PerAxis& from, const plant::PerAxis& to) noexcept {
  const double radius_m = std::max(std::abs(from[0]), std::abs(to[0]));
  const double distance_m =
      std::abs(to[0] - from[0]) + radius_m * std::abs(to[1] - from[1]) + std::abs(to[2] - from[2]);
  return std::clamp(static_cast<int>(std::min(distance_m / kStep_m, 1.0 * kMostSteps)), 1, kMostSteps);
}

}  // namespace

double clearance_m(const Zone& zone, const ReachedSpace& space, double suspension_height_m) noexcept {
  const double beside = outline_distance_m(zone, space.x_m, space.y_m) - space.radius_m;
  const double above = space.lowest_m - zone.top_m, below = zone.bottom_m - suspension_height_m;
  return std::max({beside, above, below});
}

ReachedSpace resting_space(const Clearance& clearance, double gravity_mps2, double trolley_m, double slew_rad,
                           double cable_m) noexcept {
  const double longest_m = cable_m * (1 + clearance.cable_error);
  return {.x_m = trolley_m * std::cos(slew_rad),
          .y_m = trolley_m * std::sin(slew_rad),
          .radius_m = clearance.load_radius_m + 2 * clearance.wind_mps2 * longest_m / gravity_mps2,
          .lowest_m = clearance.suspension_height_m - longest_m - clearance.load_radius_m};
}

const Zone* zone_in_path(std::span<const Zone> zones, const Clearance& clearance, double gravity_mps2,
                         const plant::PerAxis& from, const plant::PerAxis& to,
                         double least_clearance_m) noexcept {
  const int steps = steps_of(from, to);
  for (const Zone& zone : zones) {
    double closest_m = least_clearance_m;
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const auto at = [&](std::size_t axis) { return from[axis] + share * (to[axis] - from[axis]); };
      const double gap_m = clearance_m(zone, resting_space(clearance, gravity_mps2, at(0), at(1), at(2)),
                                       clearance.suspension_height_m);
      if (i == 0) closest_m = std::min(closest_m, gap_m);
      if (!(gap_m >= closest_m - kRounding_m)) return &zone;
    }
  }
  return nullptr;
}

}  // namespace crane::control
