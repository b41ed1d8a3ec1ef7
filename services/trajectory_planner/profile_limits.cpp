#include "trajectory_planner/profile_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crane::services {
namespace {

/// Largest steps of the reference, m and rad: those of the maneuvers for which the laws with step references
/// were designed (0.75 m and 90 degrees), with some room. A larger step saturates the drives, and a jib that
/// turns fast throws the load outwards.
constexpr std::array<double, control::kAxes> kLargestStep{1.2, 1.7, 0};
/// Largest outward swing, rad, at the speed of a slew profile that replaces a step: w^2 x / g.
constexpr double kOutwardSwing_rad = 0.03;
/// The laws move the trolley outwards to reduce an outward swing: by at most 5 m per rad of w^2 x / g, with
/// some room.
constexpr double kOutwardTravel_mprad = 8;
/// Distance of the trolley from its high limit, m, below which this motion reaches the limit after a step.
constexpr double kRoomOfStep_m = 0.35;
/// Least share of the reference speed.
constexpr double kSlowest = 0.1;

}  // namespace

ProfileLimits profile_limits(const configuration::Rig& rig, control::ReferenceShape shape,
                             const control::Reference& now, const MoveTarget& move) noexcept {
  const auto target = [&](std::size_t i) { return move.selected[i] ? move.target[i] : now[i].position; };
  const auto travel = [&](std::size_t i) { return std::abs(target(i) - now[i].position); };
  const auto& trolley = rig.drives[control::kTrolley];
  const double speed_radps = rig.drives[control::kSlew].reference_speed,
               radius_m =
                   std::max(std::abs(now[control::kTrolley].position), std::abs(target(control::kTrolley))),
               room_m =
                   trolley.present ? trolley.high_limit - radius_m : std::numeric_limits<double>::infinity();
  const bool near_the_end = travel(control::kSlew) > 0 && room_m < kRoomOfStep_m;
  const bool uses_steps = shape == control::ReferenceShape::step;
  if (uses_steps && !near_the_end && travel(control::kTrolley) <= kLargestStep[control::kTrolley] &&
      travel(control::kSlew) <= kLargestStep[control::kSlew])
    return {.steps = true, .slew_speed_radps = speed_radps};
  if (!(uses_steps || near_the_end) || !(radius_m > 0)) return {.slew_speed_radps = speed_radps};
  const double swing_rad = std::min(kOutwardSwing_rad, std::max(0.0, room_m) / kOutwardTravel_mprad);
  return {.slew_speed_radps = std::clamp(std::sqrt(swing_rad * rig.design.crane.gravity_mps2 / radius_m),
                                         kSlowest * speed_radps, speed_radps)};
}

}  // namespace crane::services
