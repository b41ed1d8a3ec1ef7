#include "crane/control/route.hpp"

#include <algorithm>
#include <cmath>

#include "leg.hpp"

namespace crane::control {
namespace {

/// Profile of the share of a leg, within the limits of all axes.
AxisProfile profile_of(const PathSpace& space, const PerAxis& displacement, double share) {
  AxisLimits limits{.speed = 1e9, .acceleration = 1e9, .jerk = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& axis = space.axis[i];
    const double distance = std::abs(displacement[i]);
    if (!axis.present || !(distance > 0)) continue;
    limits.speed = std::min(limits.speed, share * axis.speed / distance);
    limits.acceleration = std::min(limits.acceleration, axis.acceleration / 2 / distance);
    if (std::isfinite(axis.jerk)) limits.jerk = std::min(limits.jerk, axis.jerk / 2 / distance);
  }
  return limited_profile(0, 1, limits);
}

PerAxis along(const PerAxis& from, const PerAxis& displacement, double share) noexcept {
  PerAxis at{};
  for (std::size_t i = 0; i < kAxes; ++i) at[i] = from[i] + share * displacement[i];
  return at;
}

/// Largest speed of a leg; `at`: one of its places.
double speed_over_ground_mps(const PerAxis& at, const PerAxis& displacement,
                             const AxisProfile& profile) noexcept {
  return profile.speed * ground_distance_m(at, along(at, displacement, 1));
}

}  // namespace

Route::Route(const PathSpace& space, const PerAxis& start, const std::vector<Waypoint>& points,
             const RouteStyle& style)
    : start_{start}, target_{start} {
  constexpr double kNegligible = 1e-6;  // m, rad: shorter legs are left out
  PerAxis corner = start;
  for (const auto& point : points) {
    PerAxis displacement{};
    double longest = 0;
    for (std::size_t i = 0; i < kAxes; ++i) {
      if (space.axis[i].present) displacement[i] = point.position[i] - corner[i];
      longest = std::max(longest, std::abs(displacement[i]));
    }
    if (longest < kNegligible) continue;
    RouteLeg leg{.profile = profile_of(space, displacement, point.speed_share * style.speed_factor),
                 .displacement = displacement};
    if (!legs_.empty()) {
      const RouteLeg& before = legs_.back();
      const double end_s = before.begin_s + before.profile.duration_s();
      const double overlap_s = style.overlaps ? std::min(before.profile.ramp_s, leg.profile.ramp_s) : 0;
      const double window_s = overlap_s + style.delay_s;
      const PerAxis early = along(corner, before.displacement,
                                  before.profile.at(before.profile.duration_s() - window_s).position - 1);
      const PerAxis late = along(corner, displacement, leg.profile.at(window_s).position);
      const Leg chord = leg_of(space, completed(space, early), completed(space, late), kPassClearance_m);
      const double speed_mps = std::max(speed_over_ground_mps(early, before.displacement, before.profile),
                                        speed_over_ground_mps(corner, displacement, leg.profile));
      const bool blends =
          style.blends && chord.is_free &&
          passing_speed_mps(space, chord.clearance_m, completed(space, corner)[kHoist]) >= speed_mps;
      leg.begin_s = blends ? end_s - overlap_s : end_s + style.delay_s;
    }
    corner = along(corner, displacement, 1);
    duration_s_ = leg.begin_s + leg.profile.duration_s();
    legs_.push_back(leg);
  }
  for (std::size_t i = 0; i < kAxes; ++i)
    if (space.axis[i].present && !points.empty()) target_[i] = points.back().position[i];
}

AxisReference Route::at(std::size_t axis, double time_s) const noexcept {
  if (time_s >= duration_s_) return {.position = target_[axis]};
  AxisReference sum{.position = start_[axis]};
  for (const RouteLeg& leg : legs_) {
    const double time_of_leg_s = time_s - leg.begin_s;
    if (time_of_leg_s <= 0) break;
    const AxisReference share = leg.profile.at(time_of_leg_s);
    sum.position += leg.displacement[axis] * share.position;
    sum.speed += leg.displacement[axis] * share.speed;
    sum.acceleration += leg.displacement[axis] * share.acceleration;
  }
  return sum;
}

}  // namespace crane::control
