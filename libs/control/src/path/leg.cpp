#include "leg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crane::control {
namespace {

// Chosen values: they affect the duration of a move and stops by the zone filter. The zone filter alone keeps
// the load out of the zones.
constexpr double kSlowest_mps = 0.03;   // lowest speed over the ground: friction makes a slower motion uneven
constexpr double kSlowestShare = 0.05;  // lowest speed / reference speed
constexpr double kBlend_m = 0.01;       // largest distance between a blended corner and its straight legs
constexpr double kReaction_s = 0.1;     // two ticks, ramp and closing time of the brakes
// Smallest distance of two samples: between them, the clearance is smaller by at most half this distance.
constexpr double kLeastStep_m = 0.003;
constexpr double kLargestStep_m = 0.05;  // largest distance of two samples of a leg

PerAxis between(const PerAxis& from, const PerAxis& to, double share) noexcept {
  PerAxis at{};
  for (std::size_t i = 0; i < kAxes; ++i) at[i] = from[i] + share * (to[i] - from[i]);
  return at;
}

}  // namespace

double ground_distance_m(const PerAxis& from, const PerAxis& to) noexcept {
  const double radius_m = std::max(std::abs(from[kTrolley]), std::abs(to[kTrolley]));
  return std::hypot(to[kTrolley] - from[kTrolley], radius_m * (to[kSlew] - from[kSlew]));
}

double passing_speed_mps(const PathSpace& space, double clearance_m, double cable_m) noexcept {
  // A stop from the speed v leaves a swing of v sqrt(L/g). The acceleration before the stop may have left the
  // same swing.
  const double swing_s = 2 * std::sqrt(cable_m * (1 + space.clearance.cable_error) / space.gravity_mps2);
  return std::max(kSlowest_mps, (clearance_m - kRestClearance_m - kBlend_m) / (swing_s + kReaction_s));
}

double cruise_time_s(const PathSpace& space, const PerAxis& from, const PerAxis& to, double share) noexcept {
  double longest_s = 0;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (space.axis[i].present)
      longest_s = std::max(longest_s, std::abs(to[i] - from[i]) / (share * space.axis[i].speed));
  return longest_s;
}

double speed_share(const PathSpace& space, const PerAxis& from, const PerAxis& to,
                   double clearance_m) noexcept {
  const double full_s = cruise_time_s(space, from, to, 1), distance_m = ground_distance_m(from, to);
  if (!(full_s > 0) || !(distance_m > 0)) return 1;
  const double cable_m = std::max(from[kHoist], to[kHoist]);
  return std::clamp(passing_speed_mps(space, clearance_m, cable_m) * full_s / distance_m, kSlowestShare, 1.0);
}

PerAxis completed(const PathSpace& space, PerAxis position) noexcept {
  constexpr double kShortest_m = 0.05;
  if (!space.axis[kSlew].present) position[kSlew] = 0;
  position[kHoist] = space.cable_measured ? std::max(position[kHoist], kShortest_m) : space.cable_m;
  return position;
}

ClosestZone closest_zone(const PathSpace& space, const PerAxis& position) noexcept {
  const auto reached = resting_space(space.clearance, space.gravity_mps2, position[kTrolley], position[kSlew],
                                     position[kHoist]);
  ClosestZone closest{.clearance_m = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < space.zones.size(); ++i) {
    const Zone& zone = space.zones[i];
    const bool box = zone.shape == ZoneShape::box;
    const double bound_m =
        std::max(std::abs(reached.x_m - zone.position_x_m) - (box ? zone.size_x_m / 2 : zone.radius_m),
                 std::abs(reached.y_m - zone.position_y_m) - (box ? zone.size_y_m / 2 : zone.radius_m));
    if (bound_m - reached.radius_m > closest.clearance_m) continue;  // lower bound of the horizontal distance
    const double gap_m = clearance_m(zone, reached, space.clearance.suspension_height_m);
    if (!(gap_m >= closest.clearance_m)) closest = {gap_m, i};  // a zone with NaN counts as the closest
  }
  return closest;
}

double straight_clearance_m(const PathSpace& space, const PerAxis& from, const PerAxis& to) noexcept {
  return leg_of(space, from, to, kRestClearance_m).clearance_m;
}

Leg leg_of(const PathSpace& space, const PerAxis& from, const PerAxis& to,
           double least_clearance_m) noexcept {
  const double growth = std::abs(to[kHoist] - from[kHoist]) * (1 + space.clearance.cable_error) *
                        (1 + 2 * space.clearance.wind_mps2 / space.gravity_mps2);
  const double distance_m = ground_distance_m(from, to) + growth;
  const double needed_m = least_clearance_m + kLeastStep_m / 2;
  Leg leg{.is_free = true, .clearance_m = std::numeric_limits<double>::infinity()};
  for (double s = 0;;) {
    const auto here = closest_zone(space, distance_m > 0 ? between(from, to, s / distance_m) : to);
    if (!(here.clearance_m >= leg.clearance_m)) leg.clearance_m = here.clearance_m, leg.zone = here.zone;
    if (!(here.clearance_m >= needed_m)) {
      leg.is_free = false;
      return leg;
    }
    if (s >= distance_m) break;
    s = std::min(distance_m,
                 s + std::clamp(here.clearance_m - least_clearance_m, kLeastStep_m, kLargestStep_m));
  }
  leg.speed_share = speed_share(space, from, to, leg.clearance_m);
  double ramp_s = 0;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (space.axis[i].present && to[i] != from[i])
      ramp_s = std::max(ramp_s, leg.speed_share * space.axis[i].speed / (space.axis[i].acceleration / 2));
  leg.duration_s = cruise_time_s(space, from, to, leg.speed_share) + ramp_s;
  return leg;
}

}  // namespace crane::control
