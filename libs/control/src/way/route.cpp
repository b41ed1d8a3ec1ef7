#include "crane/control/route.hpp"

#include <algorithm>
#include <cmath>

#include "leg.hpp"

namespace crane::control {
namespace {

using plant::PerAxis;

/// Profile of the share of a leg, within the limits of all axes.
AxisProfile profile_of(const WaySpace& space, const PerAxis& way, double share) {
  AxisLimits limits{.speed = 1e9, .acceleration = 1e9, .jerk = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& axis = space.axis[i];
    const double distance = std::abs(way[i]);
    if (!axis.present || !(distance > 0)) continue;
    limits.speed = std::min(limits.speed, share * axis.speed / distance);
    limits.acceleration = std::min(limits.acceleration, axis.acceleration / 2 / distance);
    if (std::isfinite(axis.jerk)) limits.jerk = std::min(limits.jerk, axis.jerk / 2 / distance);
  }
  return limited_profile(0, 1, limits);
}

PerAxis along(const PerAxis& from, const PerAxis& way, double share) noexcept {
  PerAxis at{};
  for (std::size_t i = 0; i < kAxes; ++i) at[i] = from[i] + share * way[i];
  return at;
}

/// Largest speed of a leg; `at`: one of its places.
double speed_over_ground_mps(const PerAxis& at, const PerAxis& way, const AxisProfile& profile) noexcept {
  return profile.speed * ground_way_m(at, along(at, way, 1));
}

}  // namespace

Route::Route(const WaySpace& space, const PerAxis& start, const std::vector<Waypoint>& points,
             const RouteStyle& style)
    : start_{start}, target_{start} {
  constexpr double kNegligible = 1e-6;  // m, rad: shorter legs are left out
  PerAxis corner = start;
  for (const auto& point : points) {
    PerAxis way{};
    double longest = 0;
    for (std::size_t i = 0; i < kAxes; ++i) {
      if (space.axis[i].present) way[i] = point.position[i] - corner[i];
      longest = std::max(longest, std::abs(way[i]));
    }
    if (longest < kNegligible) continue;
    RouteLeg leg{.profile = profile_of(space, way, point.speed_share * style.speed_factor), .way = way};
    if (!legs_.empty()) {
      const RouteLeg& before = legs_.back();
      const double end_s = before.begin_s + before.profile.duration_s();
      const double overlap_s = style.overlaps ? std::min(before.profile.ramp_s, leg.profile.ramp_s) : 0;
      const double window_s = overlap_s + style.delay_s;
      const PerAxis early =
          along(corner, before.way, before.profile.at(before.profile.duration_s() - window_s).position - 1);
      const PerAxis late = along(corner, way, leg.profile.at(window_s).position);
      const Leg chord = leg_of(space, completed(space, early), completed(space, late), kPassGap_m);
      const double speed_mps = std::max(speed_over_ground_mps(early, before.way, before.profile),
                                        speed_over_ground_mps(corner, way, leg.profile));
      const bool blends =
          style.blends && chord.is_free &&
          passing_speed_mps(space, chord.clearance_m, completed(space, corner)[kHoist]) >= speed_mps;
      leg.begin_s = blends ? end_s - overlap_s : end_s + style.delay_s;
    }
    corner = along(corner, way, 1);
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
    sum.position += leg.way[axis] * share.position;
    sum.speed += leg.way[axis] * share.speed;
    sum.acceleration += leg.way[axis] * share.acceleration;
  }
  return sum;
}

}  // namespace crane::control
