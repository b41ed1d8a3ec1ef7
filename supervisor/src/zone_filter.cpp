#include "crane/supervisor/zone_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "crane/plant/pendulum.hpp"
#include "ramped_stop.hpp"

namespace crane::supervisor {
namespace {

using Plane = ZoneMemory::Plane;
using control::ReachedSpace;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;

double clearance_of(const Limits& limits, std::size_t zone, const ReachedSpace& reach) noexcept {
  return control::clearance_m(limits.zones[zone], reach, limits.clearance.suspension_height_m);
}

/// True while a load inside the margin of the zone leaves it.
bool leaves(const ZoneMemory& memory, std::size_t zone) noexcept { return memory.permitted_m[zone] < 0; }

/// Additional travel of a controlled stop beyond that of a ramped stop, m or rad; the sign is that of the
/// speed.
double deceleration_travel(const Limits& limits, std::size_t axis, double speed,
                           double omega_radps) noexcept {
  // from the decision until the controllers follow the planner's new reference
  constexpr int kStopDelay_ticks = 4;
  const double a = limits.reference_acceleration[axis], v = std::abs(speed);
  if (!limits.axis[axis].present || !(a > 0) || v < limits.axis[axis].standstill_speed) return 0;
  const double excess = std::max(0.0, v - a / omega_radps);
  const double travel = v * kStopDelay_ticks * limits.period_s + excess * excess / (2 * a);
  return speed > 0 ? travel : -travel;
}

/// @return the first zone that the reached space touches when each axis travels
///   deceleration_travel() before the ramped stop; nothing: none. Ignores zones that the load
///   leaves, whose clearance is below 0.
std::optional<std::size_t> zone_ahead(const Limits& limits, const ZoneInput& input, const ZoneMemory& memory,
                                      const RampedStop& stop, const ReachedSpace& now) noexcept {
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
    for (std::size_t zone = 0; zone < limits.zones.size(); ++zone)
      if (!leaves(memory, zone) && clearance_of(limits, zone, reach) < 0) return zone;
  }
  return std::nullopt;
}

/// Sets the permitted clearance of each zone when the brakes open. Arming again inside the same margin
/// permits no further approach to the zone.
void begin_watching(const Limits& limits, const ZoneInput& input, const ReachedSpace& reach,
                    ZoneMemory& memory) noexcept {
  const ReachedSpace resting = control::resting_space(
      limits.clearance, limits.machine.crane.gravity_mps2, input.position[kTrolley],
      limits.axis[kSlew].present ? input.position[kSlew] : 0, limits.machine.cable(input.position[kHoist]));
  for (std::size_t zone = 0; zone < limits.zones.size(); ++zone) {
    double& permitted_m = memory.permitted_m[zone];
    const double gap_m = clearance_of(limits, zone, reach), before_m = permitted_m < 0 ? permitted_m : gap_m;
    permitted_m = clearance_of(limits, zone, resting) < 0 ? std::min(std::max(before_m, gap_m), 0.0) : 0;
  }
  memory.watching = true;
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

ReachedSpace ramped_stop_space(const Limits& limits, const ZoneInput& input,
                               const ZoneMemory& memory) noexcept {
  return reached_space_of(limits, ramped_stop(limits, input, memory));
}

ZoneVerdict filter_zones(const Limits& limits, const ZoneInput& input, ZoneMemory& memory) noexcept {
  if (limits.zones.empty()) return {};
  if (memory.samples < 2) return {.needs_controlled_stop = true, .needs_ramped_stop = true};
  const RampedStop stop = ramped_stop(limits, input, memory);
  const ReachedSpace reach = reached_space_of(limits, stop);
  if (!memory.watching) begin_watching(limits, input, reach, memory);
  const auto ahead = zone_ahead(limits, input, memory, stop, reach);
  ZoneVerdict verdict{.needs_controlled_stop = ahead.has_value()};
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t zone = 0; zone < limits.zones.size(); ++zone) {
    double& permitted_m = memory.permitted_m[zone];
    const double gap_m = clearance_of(limits, zone, reach);
    const double spare_m = gap_m - permitted_m + (leaves(memory, zone) ? kLeaveTolerance_m : 0);
    if (!(spare_m >= least_m)) {  // true for NaN, too
      least_m = spare_m;
      verdict.zone = zone, verdict.clearance_m = gap_m;
    }
    verdict.needs_ramped_stop = verdict.needs_ramped_stop || !(spare_m >= 0);
    permitted_m = std::min(0.0, std::max(permitted_m, gap_m));
  }
  if (ahead && !verdict.needs_ramped_stop)
    verdict.zone = *ahead, verdict.clearance_m = clearance_of(limits, *ahead, reach);
  return verdict;
}

}  // namespace crane::supervisor
