#include "ramped_stop.hpp"

#include "crane/supervisor/following.hpp"

namespace crane::supervisor {
namespace {

using Plane = ZoneMemory::Plane;
using PastSample = ZoneMemory::PastSample;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;

double square(double x) noexcept { return x * x; }
double length(const Plane& a) noexcept { return std::hypot(a[0], a[1]); }

/// Integral of the voltage over time in one direction (+1 or -1), V s: half of the previous tick,
/// the present tick and the next tick, the last one repeated for each missing state (docs/zones.md,
/// step 1).
double impulse_vs(const Limits& limits, std::size_t axis, double direction, const ZoneInput& input,
                  const ZoneMemory& memory) noexcept {
  const auto push = [direction](double v) { return std::max(direction * v, 0.0); };
  return limits.period_s * (push(memory.previous_applied_v[axis]) / 2 + push(input.applied_v[axis]) +
                            (1 + input.missing_ticks) * push(input.gate_output_v[axis]));
}

double gain_of(const Limits& limits, std::size_t axis) noexcept {
  const auto& crane = limits.machine.crane;
  return (1 + kGainTolerance) * (axis == kTrolley ? crane.trolley_gain_mps2pv : crane.slew_gain_radps2pv);
}

/// Step 1 of docs/zones.md. @param load_acceleration  by load, centrifugal and Coriolis force, unit/s^2
StopTravel stop_travel(const Limits& limits, std::size_t axis, const ZoneInput& input,
                       const ZoneMemory& memory, double load_acceleration) noexcept {
  if (!limits.axis[axis].present) return {};
  const double react_s = stopping_time_s(limits, axis) + input.missing_ticks * limits.period_s;
  StopTravel travel;
  for (const double direction : {1.0, -1.0}) {
    const double v = direction * input.speed[axis];
    const double gained = gain_of(limits, axis) * impulse_vs(limits, axis, direction, input, memory) +
                          load_acceleration * (react_s + limits.period_s / 2);
    const double most = std::max(v + gained, 0.0);
    const double brake = limits.axis[axis].brake_deceleration;
    (direction > 0 ? travel.up : travel.down) = most * react_s + most * most / (2 * brake);
    travel.speed = std::max(travel.speed, most);
    travel.duration_s = std::max(travel.duration_s, react_s + most / brake);
  }
  return travel;
}

StopTravel hoist_stop_travel(const Limits& limits, const ZoneInput& input,
                             const ZoneMemory& memory) noexcept {
  if (!limits.axis[kHoist].present) return {};
  const auto& crane = limits.machine.crane;
  const double react_s = stopping_time_s(limits, kHoist) + input.missing_ticks * limits.period_s;
  const double share = std::min(1.0, (2.5 + input.missing_ticks) * limits.period_s / crane.hoist_lag_s);
  StopTravel travel;
  for (const double direction : {1.0, -1.0}) {
    const double volts =
        std::max({direction * memory.previous_applied_v[kHoist], direction * input.applied_v[kHoist],
                  direction * input.gate_output_v[kHoist], 0.0});
    const double v = direction * input.speed[kHoist];
    const double driven = (1 + kGainTolerance) * crane.hoist_gain_mpspv * volts;
    const double most = std::max(v + std::max(driven - v, 0.0) * share, 0.0);
    (direction > 0 ? travel.up : travel.down) =
        most * react_s + most * most / (2 * limits.axis[kHoist].brake_deceleration);
  }
  return travel;
}

/// Upper bound of the speed of the load, m/s: the mean velocity over the span, extrapolated to the
/// newest sample with the acceleration of the pendulum (-g times the horizontal part of the cable),
/// plus bounds for the quantisation of the encoders, the error of that acceleration and the wind.
double load_speed_mps(const Limits& limits, const ZoneMemory& memory, const LoadMotion& load) noexcept {
  if (memory.samples < 2) return 0;
  const PastSample &now = memory.recent[0], &then = memory.recent[memory.samples - 1];
  const double span_s = now.sampled_s - then.sampled_s, g = limits.machine.crane.gravity_mps2;
  double speed = 0;
  for (const double cable_m : {load.shortest_m, load.longest_m}) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double pivot = i < 2 ? now.pivot_m[i] - then.pivot_m[i] : 0;
      const double mean = (pivot + cable_m * (now.cable[i] - then.cable[i])) / span_s;
      const double pendulum_mps2 = i < 2 ? -g * (then.cable[i] + 2 * now.cable[i]) / 3 : 0;
      sum += square(mean + pendulum_mps2 * span_s / 2);
    }
    speed = std::max(speed, std::sqrt(sum));
  }
  const auto& machine = limits.machine;
  const double counts_m =
      load.longest_m * std::hypot(machine.swing_resolution_rad[0], machine.swing_resolution_rad[1]) +
      machine.resolution[kTrolley] + length(now.pivot_m) * machine.resolution[kSlew];
  const double unmodelled = g * square(load.swing) * (1 + load.swing) + limits.clearance.wind_mps2;
  return speed + counts_m / span_s + unmodelled * span_s / 2;
}

/// Step 2 of docs/zones.md.
StopRegion stop_region(double trolley_m, double slew_rad, const StopTravel& trolley,
                       const StopTravel& slew) noexcept {
  const double near_m = trolley_m - trolley.down, far_m = trolley_m + trolley.up;
  const double half_rad = (slew.up + slew.down) / 2, middle_rad = slew_rad + (slew.up - slew.down) / 2;
  const double middle_m = (near_m + far_m) / 2;
  StopRegion region{.middle_m = middle_m, .middle_rad = middle_rad, .centre = polar(middle_m, middle_rad)};
  for (const double corner_m : {near_m, far_m}) {
    const Plane corner = polar(corner_m, half_rad);
    region.radius_m = std::max(region.radius_m, std::hypot(corner[0] - middle_m, corner[1]));
  }
  return region;
}

/// A: step 3 of docs/zones.md.
double swing_of_stop_m(const Limits& limits, const ZoneMemory& memory, const RampedStop& stop) noexcept {
  const auto& [load, trolley, slew, region, unused] = stop;
  const PastSample& now = memory.recent[0];
  const double g = limits.machine.crane.gravity_mps2, longest = load.longest_m, shortest = load.shortest_m;
  const double far_m = length(now.pivot_m) + trolley.longest();
  const double travel_m = trolley.longest() + far_m * slew.longest();
  const double pivot_mps = std::hypot(trolley.speed, far_m * slew.speed);
  const double t = std::max(trolley.duration_s, slew.duration_s);
  const double n = longest * load.swing;
  const double swing_phase_squared = g / shortest * t * t;
  const double n_most =
      std::min(longest, (n + travel_m + load.speed_mps * t) * (1 + std::min(swing_phase_squared, 1.0)));
  const double kappa = 1 + square(load.speed_mps + pivot_mps) / (g * shortest);
  double e = 0;
  for (const double cable_m : {shortest, longest})
    e = std::max(e, std::hypot(now.pivot_m[0] + cable_m * now.cable[0] - region.centre[0],
                               now.pivot_m[1] + cable_m * now.cable[1] - region.centre[1]));
  e += region.radius_m;
  const double moved = 2 * travel_m * (load.speed_mps * t + kappa * swing_phase_squared * n_most / 2);
  const double braked = 2 * longest * square(std::min(1.0, n_most / shortest) * pivot_mps) / g;
  const double a2 =
      n * n + longest * square(load.speed_mps) / g + kappa * (std::max(0.0, e * e - n * n) + moved) + braked;
  return std::min(longest, std::sqrt(a2));
}

/// Accelerations of trolley and slew axis by the load, with its largest mass, and by the turning jib.
struct LoadAccelerations {
  double trolley_mps2 = 0, slew_radps2 = 0;
};
LoadAccelerations load_accelerations(const Limits& limits, const ZoneInput& input, const ZoneMemory& memory,
                                     const LoadMotion& load) noexcept {
  const auto& crane = limits.machine.crane;
  const double x = std::abs(input.position[kTrolley]), g = crane.gravity_mps2,
               mass_kg = kLoadRatioMax * crane.load_mass_kg;
  const double turn_s = stopping_time_s(limits, kTrolley) + input.missing_ticks * limits.period_s;
  const double swing = std::min(
      1.0, load.swing + (load.speed_mps + std::abs(input.speed[kTrolley])) * turn_s / load.shortest_m);
  const double force = mass_kg * g * swing * (1 + square(load.speed_mps) / (g * load.shortest_m));
  double slew_radps = 0, trolley_mps = std::abs(input.speed[kTrolley]);
  if (limits.axis[kSlew].present) {
    slew_radps = std::abs(input.speed[kSlew]);
    slew_radps += gain_of(limits, kSlew) * std::max(impulse_vs(limits, kSlew, 1, input, memory),
                                                    impulse_vs(limits, kSlew, -1, input, memory));
  }
  return {.trolley_mps2 = force / crane.trolley_inertia_kg + (crane.trolley_mass_kg + mass_kg) /
                                                                 crane.trolley_inertia_kg * x * slew_radps *
                                                                 slew_radps,
          .slew_radps2 = force * x / crane.jib_inertia_kgm2 + 2 * (crane.trolley_mass_kg + mass_kg) /
                                                                  crane.jib_inertia_kgm2 * x * trolley_mps *
                                                                  slew_radps};
}

}  // namespace

RampedStop ramped_stop(const Limits& limits, const ZoneInput& input, const ZoneMemory& memory) noexcept {
  constexpr double kShortest_m = 0.01;
  const PastSample& now = memory.recent[0];
  const StopTravel hoist = hoist_stop_travel(limits, input, memory);
  const double cable_m = limits.machine.cable(input.position[kHoist]), error = limits.clearance.cable_error;
  RampedStop stop;
  stop.load = {.shortest_m = std::max(kShortest_m, (cable_m - hoist.down) * (1 - error)),
               .longest_m = (cable_m + hoist.up) * (1 + error),
               .swing = std::min(1.0, std::hypot(now.cable[0], now.cable[1]))};
  stop.load.speed_mps = load_speed_mps(limits, memory, stop.load);
  const LoadAccelerations by_load = load_accelerations(limits, input, memory, stop.load);
  stop.trolley = stop_travel(limits, kTrolley, input, memory, by_load.trolley_mps2);
  stop.slew = stop_travel(limits, kSlew, input, memory, by_load.slew_radps2);
  stop.region = stop_region(input.position[kTrolley], limits.axis[kSlew].present ? input.position[kSlew] : 0,
                            stop.trolley, stop.slew);
  stop.swing_m = swing_of_stop_m(limits, memory, stop);
  return stop;
}

control::ReachedSpace reached_space_of(const Limits& limits, const RampedStop& stop) noexcept {
  const auto& clearance = limits.clearance;
  const double longest = stop.load.longest_m;
  return {.x_m = stop.region.centre[0],
          .y_m = stop.region.centre[1],
          .radius_m = stop.region.radius_m + stop.swing_m +
                      2 * clearance.wind_mps2 * longest / limits.machine.crane.gravity_mps2 +
                      clearance.load_radius_m,
          .lowest_m = clearance.suspension_height_m - longest - clearance.load_radius_m};
}

}  // namespace crane::supervisor
