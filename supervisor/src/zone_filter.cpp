#include "crane/supervisor/zone_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crane/plant/pendulum.hpp"
#include "ramped_stop.hpp"

namespace crane::supervisor {
namespace {

using Plane = ZoneMemory::Plane;
using control::ReachedSpace;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;

struct Closest {
  std::size_t zone = 0;
  double clearance_m = std::numeric_limits<double>::infinity();
};
Closest closest_of(const Limits& limits, const ReachedSpace& reach) noexcept {
  Closest closest;
  for (std::size_t i = 0; i < limits.zones.size(); ++i) {
    const double gap_m = control::clearance_m(limits.zones[i], reach, limits.clearance.suspension_height_m);
    if (!(gap_m >= closest.clearance_m)) closest = {i, gap_m};  // a zone with NaN counts as the closest
  }
  return closest;
}

/// Signed distance that a controlled stop needs in the direction of motion beyond the distance of a ramped
/// stop, unit.
double deceleration_travel(const Limits& limits, std::size_t axis, double speed,
                           double omega_radps) noexcept {
  // from the decision until the controllers follow the planner's new reference
  constexpr int kTicksOfStop = 4;
  const double a = limits.reference_acceleration[axis], v = std::abs(speed);
  if (!limits.axis[axis].present || !(a > 0) || v < limits.axis[axis].standstill_speed) return 0;
  const double excess = std::max(0.0, v - a / omega_radps);
  const double travel = v * kTicksOfStop * limits.period_s + excess * excess / (2 * a);
  return speed > 0 ? travel : -travel;
}

/// True when the reached space of a ramped stop, shifted by deceleration_travel() of each axis, touches a
/// zone.
bool is_ahead(const Limits& limits, const ZoneInput& input, const RampedStop& stop,
              const ReachedSpace& now) noexcept {
  constexpr int kPoints = 8;
  const double omega = plant::swing_radps(limits.machine.crane.gravity_mps2, stop.load.longest_m);
  const double trolley = deceleration_travel(limits, kTrolley, input.speed[kTrolley], omega);
  const double slew = deceleration_travel(limits, kSlew, input.speed[kSlew], omega);
  const double lower = std::max(0.0, deceleration_travel(limits, kHoist, input.speed[kHoist], omega));
  for (int i = 1; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / kPoints;
    const Plane centre = polar(stop.region.middle_m + share * trolley, stop.region.middle_rad + share * slew);
    const ReachedSpace reach{.x_m = centre[0],
                             .y_m = centre[1],
                             .radius_m = now.radius_m,
                             .lowest_m = now.lowest_m - share * lower};
    if (closest_of(limits, reach).clearance_m < 0) return true;
  }
  return false;
}

}  // namespace

void observe_load(const Limits& limits, const ZoneInput& input, ZoneMemory& memory) noexcept {
  if (limits.zones.empty()) return;
  if (memory.samples > 0 && !(input.sampled_s > memory.recent[0].sampled_s)) return;
  const bool slews = limits.axis[kSlew].present;
  const double slew_rad = slews ? input.position[kSlew] : 0, c = std::cos(slew_rad), s = std::sin(slew_rad);
  const double phi = input.swing_radial_rad, theta = slews ? input.swing_tangential_rad : 0;
  const double along = -std::cos(theta) * std::sin(phi),
               across = std::sin(theta);  // (2.11) of H. M. Omar, Control of Gantry and Tower Cranes
  std::shift_right(memory.recent.begin(), memory.recent.end(), 1);
  memory.recent[0] = {
      .sampled_s = input.sampled_s,
      .pivot_m = polar(input.position[kTrolley], slew_rad),
      .cable = {along * c - across * s, along * s + across * c, -std::cos(theta) * std::cos(phi)}};
  memory.samples = std::min(memory.samples + 1, memory.recent.size());
  memory.previous_applied_v = memory.applied_v;
  memory.applied_v = input.applied_v;
}

ReachedSpace ramped_reach(const Limits& limits, const ZoneInput& input, const ZoneMemory& memory) noexcept {
  return reach_of(limits, ramped_stop(limits, input, memory));
}

ZoneVerdict filter_zones(const Limits& limits, const ZoneInput& input, ZoneMemory& memory) noexcept {
  if (limits.zones.empty()) return {};
  if (memory.samples < 2) return {.ahead = true, .touched = true};
  const RampedStop stop = ramped_stop(limits, input, memory);
  const ReachedSpace reach = reach_of(limits, stop);
  const Closest closest = closest_of(limits, reach);
  const double gap_m = closest.clearance_m;
  if (!memory.watching) {
    const ReachedSpace resting = control::resting_reach(
        limits.clearance, limits.machine.crane.gravity_mps2, input.position[kTrolley],
        limits.axis[kSlew].present ? input.position[kSlew] : 0, limits.machine.cable(input.position[kHoist]));
    // Arming again inside the same margin permits no further approach to the zone.
    const double before_m = memory.permitted_m < 0 ? memory.permitted_m : gap_m;
    memory.permitted_m =
        closest_of(limits, resting).clearance_m < 0 ? std::min(std::max(before_m, gap_m), 0.0) : 0;
    memory.watching = true;
  }
  const bool leaves = memory.permitted_m < 0;
  const ZoneVerdict verdict{.ahead = !leaves && is_ahead(limits, input, stop, reach),
                            .touched = !(gap_m >= memory.permitted_m - (leaves ? kLeaveTolerance_m : 0)),
                            .zone = closest.zone,
                            .clearance_m = gap_m};
  memory.permitted_m = std::min(0.0, std::max(memory.permitted_m, gap_m));
  return verdict;
}

}  // namespace crane::supervisor
