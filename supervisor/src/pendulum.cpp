#include "crane/supervisor/pendulum.hpp"

#include <algorithm>
#include <cmath>

namespace crane::supervisor {
namespace {

using Plane = std::array<double, 2>;

constexpr double kLongestGap_s = 0.1;  // without samples the observer starts anew
constexpr double kErratic = 3;         // second differences too large, less a fifth for each that is not
constexpr double kForgiven = 0.2;
constexpr double kSmooth = 0.5;  // per sample: a rate that noise does not make
constexpr double kBeyondMotion = 2;

Plane operator-(const Plane& a, const Plane& b) { return {a[0] - b[0], a[1] - b[1]}; }
double norm(const Plane& a) { return std::hypot(a[0], a[1]); }

/// From the frame of the jib to the ground, and back with the negative angle.
Plane turned(const Plane& a, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * a[0] - s * a[1], s * a[0] + c * a[1]};
}

struct Geometry {
  Plane pivot_m, load_m;  ///< over ground
  double cable_m;
};

Geometry geometry_of(const Limits& limits, const PendulumInput& input) {
  const double cable_m = limits.machine.cable(input.position[2]);
  const double radial = input.radial_rad, tangential = input.tangential_rad;
  const Plane hanging{-cable_m * std::cos(tangential) * std::sin(radial),
                      cable_m * std::sin(tangential)};  // (2.11)
  const Plane pivot = turned({input.position[0], 0}, input.position[1]);
  const Plane offset = turned(hanging, input.position[1]);
  return {pivot, {pivot[0] + offset[0], pivot[1] + offset[1]}, cable_m};
}

void start(const PendulumInput& input, const Geometry& at, PendulumMemory& memory) {
  const double largest = memory.largest;
  memory = {.started = true, .sampled_s = input.sampled_s, .load_m = at.load_m, .pivot_m = at.pivot_m};
  memory.swing_rad = memory.frozen_at_rad = {input.radial_rad, input.tangential_rad};
  memory.largest = largest;
}

/// Moves the observer on by one sample. @return what it has to correct: the residual, m
Plane observe_load(const Limits& limits, const Geometry& at, double dt_s, PendulumMemory& memory) {
  const double cable_m = at.cable_m;
  const Plane offset = memory.load_m - memory.pivot_m;
  const Plane pivot_mps{(at.pivot_m[0] - memory.pivot_m[0]) / dt_s,
                        (at.pivot_m[1] - memory.pivot_m[1]) / dt_s};
  const double sine = std::min(norm(offset) / cable_m, 0.99);
  const double rate_radps = norm(memory.load_mps - pivot_mps) / cable_m;
  const double pull =
      (limits.machine.crane.gravity_mps2 * std::sqrt(1 - sine * sine) + cable_m * rate_radps * rate_radps) /
      cable_m;
  constexpr double kDamping = 1;
  const double to_place = 2 * kDamping * kObserver_radps * dt_s,
               to_speed = kObserver_radps * kObserver_radps * dt_s;
  Plane residual{};
  for (std::size_t i = 0; i < 2; ++i) {
    memory.load_mps[i] -= pull * offset[i] * dt_s;
    memory.load_m[i] += memory.load_mps[i] * dt_s;
    residual[i] = at.load_m[i] - memory.load_m[i];
    memory.load_m[i] += to_place * residual[i];
    memory.load_mps[i] += to_speed * residual[i];
  }
  memory.pivot_m = at.pivot_m;
  return residual;
}

/// Largest angular acceleration of a swing that gravity, drives and brakes can make.
double largest_radps2(const Limits& limits, double cable_m) {
  const auto& p = limits.machine.crane;
  const double drive_mps2 =
      std::max(p.trolley_gain_mps2pv * limits.axis[0].volt_limit_v, limits.axis[0].brake_deceleration);
  return (p.gravity_mps2 + drive_mps2) / cable_m;
}

double judge_channel(const Limits& limits, std::size_t i, double swing_rad, double residual_rad,
                     double largest_radps2, double dt_s, double observed_radps, PendulumMemory& memory) {
  const double shown_radps = (swing_rad - memory.swing_rad[i]) / dt_s;
  const bool shakes = std::abs(shown_radps - memory.shown_radps[i]) >
                      kBeyondMotion * largest_radps2 * std::max(dt_s, limits.period_s) +
                          4 * limits.machine.swing_resolution_rad[i] / dt_s;
  memory.smooth_radps[i] += kSmooth * (shown_radps - memory.smooth_radps[i]);
  memory.erratic[i] = shakes ? memory.erratic[i] + 1 : std::max(memory.erratic[i] - kForgiven, 0.0);
  memory.shown_radps[i] = shown_radps;
  memory.swing_rad[i] = swing_rad;
  const bool stands =
      std::abs(swing_rad - memory.frozen_at_rad[i]) <= 2 * limits.machine.swing_resolution_rad[i];
  memory.frozen_ticks[i] = stands ? std::min(memory.frozen_ticks[i] + 1, kFrozen_ticks) : 0;
  if (!stands) memory.frozen_at_rad[i] = swing_rad;
  const double size = std::abs(swing_rad);
  const double frozen =
      memory.frozen_ticks[i] < kFrozen_ticks ? 0 : std::abs(residual_rad) / (kFrozen_rad + 0.05 * size);
  const double implausible =
      std::abs(residual_rad) /
      (kImplausible_rad + 0.1 * size + kRate_s * std::max(observed_radps, std::abs(memory.smooth_radps[i])));
  return std::max({frozen, implausible, memory.erratic[i] / kErratic});
}

}  // namespace

bool swing_sensor_failed(const Limits& limits, const PendulumInput& input, PendulumMemory& memory) noexcept {
  if (!limits.machine.known || (memory.started && !(input.sampled_s > memory.sampled_s))) return false;
  const auto at = geometry_of(limits, input);
  const double dt_s = input.sampled_s - memory.sampled_s;
  if (!memory.started || dt_s > kLongestGap_s) {
    start(input, at, memory);
    return false;
  }
  memory.sampled_s = input.sampled_s;
  const Plane relative_mps = memory.load_mps;
  const Plane before_m = memory.pivot_m;
  const Plane residual = turned(observe_load(limits, at, dt_s, memory), -input.position[1]);
  const Plane pivot_mps{(at.pivot_m[0] - before_m[0]) / dt_s, (at.pivot_m[1] - before_m[1]) / dt_s};
  const double rate_radps = norm(relative_mps - pivot_mps) / at.cable_m;
  const double largest = largest_radps2(limits, at.cable_m);
  const Plane swing{input.radial_rad, input.tangential_rad};
  double worst = 0;
  for (std::size_t i = 0; i < 2; ++i)
    if (limits.machine.swing_measured[i])
      worst = std::max(worst, judge_channel(limits, i, swing[i], residual[i] / at.cable_m, largest, dt_s,
                                            rate_radps, memory));
  memory.largest = std::max(memory.largest, worst);
  return worst > 1;
}

}  // namespace crane::supervisor
