#include "trajectory_planner/zone_paths.hpp"

#include <algorithm>
#include <cmath>

#include "crane/configuration/path_space.hpp"

namespace crane::services {

ZonePaths::ZonePaths(const configuration::Rig& rig) : space_{configuration::path_space_of(rig)} {
  for (std::size_t i = 0; i < control::kAxes; ++i)
    if (rig.drives[i].present) max_speed_[i] = rig.drives[i].max_speed;
}

control::Path ZonePaths::path(const plant::PerAxis& from, const plant::PerAxis& target,
                              StraightSpeed speed) const {
  auto path = control::path_to(space_, from, target);
  if (path.outcome == control::PathOutcome::straight && speed == StraightSpeed::full &&
      !is_free_at_full_speed(from, target))
    path = {.outcome = control::PathOutcome::by_waypoints, .points = {{.position = target}}};
  return path;
}

bool ZonePaths::is_free_at_full_speed(const plant::PerAxis& from, const plant::PerAxis& to) const {
  const auto begin = control::completed(space_, from), end = control::completed(space_, to);
  const double clearance_m = control::straight_clearance_m(space_, begin, end);
  const double radius_m = std::max(std::abs(begin[control::kTrolley]), std::abs(end[control::kTrolley]));
  const double fastest_mps = std::hypot(max_speed_[control::kTrolley], radius_m * max_speed_[control::kSlew]);
  const double cable_m = std::max(begin[control::kHoist], end[control::kHoist]);
  return control::passing_speed_mps(space_, clearance_m, cable_m) >= fastest_mps;
}

}  // namespace crane::services
