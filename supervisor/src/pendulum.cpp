#include "crane/supervisor/pendulum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "crane/plant/pendulum.hpp"

namespace crane::supervisor {
namespace {

using Plane = PendulumMemory::Plane;

constexpr double kLongestGap_s = 0.1;  // a longer time without samples clears the memory
constexpr double kSameTick = 0.5;      // tolerance of the time of a sample / period
constexpr double kRightAngle_rad = std::numbers::pi / 2;
constexpr double kLeastDepth = 0.2;  // smallest depth of the balance / cable length: avoids a division by 0

Plane operator-(const Plane& a, const Plane& b) { return {a[0] - b[0], a[1] - b[1]}; }
Plane operator+(const Plane& a, const Plane& b) { return {a[0] + b[0], a[1] + b[1]}; }
Plane operator*(double s, const Plane& a) { return {s * a[0], s * a[1]}; }
double dot(const Plane& a, const Plane& b) { return a[0] * b[0] + a[1] * b[1]; }
double norm(const Plane& a) { return std::hypot(a[0], a[1]); }

/// Shortens the component of `a` along `direction` by `by`, at most to 0. The other component is unchanged.
Plane shortened_along(const Plane& direction, double by, const Plane& a) {
  const double length = norm(direction);
  if (!(length > 0)) return a;
  const Plane unit = (1 / length) * direction;
  const double along = dot(a, unit);
  return a - std::copysign(std::min(std::abs(along), by), along) * unit;
}

/// Shortest time between two samples of the balance: the quantisation of cable and angles at the swing limit
/// then changes the measured vertical acceleration, a second difference of the depth, by at most kDepthNoise
/// g.
double shortest_span_s(const Limits& limits, double cable_m) {
  constexpr double kDepthNoise = 0.3;
  const auto& count = limits.machine.swing_resolution_rad;
  const double depth_m =
      limits.machine.resolution[2] +
      cable_m * std::sin(std::min(limits.swing_limit_rad, kRightAngle_rad)) * std::hypot(count[0], count[1]);
  return std::sqrt(depth_m / (kDepthNoise * limits.machine.crane.gravity_mps2));
}

/// Rotates a vector from the frame of the jib to that of the ground; the negative angle rotates it back.
Plane turned(const Plane& a, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * a[0] - s * a[1], s * a[0] + c * a[1]};
}

/// Positions with the delay of the measured swing angles. As in the bridge, the filter takes one step per
/// tick; ticks without a sample have interpolated positions.
/// @param memory  recent[1] is the previous sample
PerAxis filtered(const Limits& limits, const PendulumInput& input, PendulumMemory& memory) {
  const control::FilterSection& filter = limits.machine.swing_filter;
  if (!limits.machine.swing_filtered) return input.position;
  const PerAxis before = std::exchange(memory.unfiltered_position, input.position);
  if (!std::exchange(memory.filter_started, true)) {
    memory.filter_ticks_left = limits.machine.swing_filter_ticks;
    for (std::size_t i = 0; i < kAxes; ++i) memory.filter[i] = control::settled(filter, input.position[i]);
    return input.position;
  }
  const double elapsed_ticks = (input.sampled_s - memory.recent[1].sampled_s) / limits.period_s;
  const int ticks = std::max(1, static_cast<int>(std::lround(elapsed_ticks)));
  memory.filter_ticks_left = std::max(memory.filter_ticks_left - ticks, 0);
  PerAxis position{};
  for (std::size_t i = 0; i < kAxes; ++i)
    for (int tick = 1; tick <= ticks; ++tick)
      position[i] =
          control::step(filter, memory.filter[i], before[i] + (input.position[i] - before[i]) * tick / ticks);
  return position;
}

/// Depth and offsets by (2.11) of H. M. Omar, Control of Gantry and Tower Cranes.
PendulumMemory::PastSample past_sample(const Limits& limits, const PendulumInput& input,
                                       const PerAxis& position) {
  const double cable_m = limits.machine.cable(position[2]);
  const double radial = input.radial_rad, tangential = input.tangential_rad;
  const Plane load_offset{-cable_m * std::cos(tangential) * std::sin(radial), cable_m * std::sin(tangential)};
  return {.sampled_s = input.sampled_s,
          .pivot_m = turned({position[0], 0}, position[1]),
          .load_offset_m = turned(load_offset, position[1]),
          .depth_m = std::max(cable_m * std::cos(tangential) * std::cos(radial), kLeastDepth * cable_m)};
}

/// Balance of the newest three samples.
PendulumMemory::Balance balance_of(const Limits& limits, const PendulumMemory& memory) {
  const auto& [newest, middle, oldest] = memory.recent;
  const double newer_s = newest.sampled_s - middle.sampled_s, older_s = middle.sampled_s - oldest.sampled_s;
  const double dt_s = (newer_s + older_s) / 2;
  const auto change = [&](const Plane& c, const Plane& b, const Plane& a) {
    return (1 / newer_s) * (c - b) - (1 / older_s) * (b - a);
  };
  const Plane swing_change = change(newest.load_offset_m, middle.load_offset_m, oldest.load_offset_m);
  const Plane pivot = change(newest.pivot_m, middle.pivot_m, oldest.pivot_m);
  const double sinking_mps2 =
      ((newest.depth_m - middle.depth_m) / newer_s - (middle.depth_m - oldest.depth_m) / older_s) / dt_s;
  const double g = limits.machine.crane.gravity_mps2;
  const double apparent_gravity_mps2 = std::clamp(g - sinking_mps2, 0.0, 3 * g);
  return {.error_mps =
              swing_change + pivot + (apparent_gravity_mps2 / middle.depth_m * dt_s) * middle.load_offset_m,
          .swing_change_mps = swing_change};
}

/// Removes the components along directions whose swing is not measured. @param slew_rad  newest
/// angle of the jib
Plane measured(const Limits& limits, const Plane& ground, double slew_rad) {
  Plane jib = turned(ground, -slew_rad);
  for (std::size_t i = 0; i < 2; ++i)
    if (!limits.machine.swing_measured[i]) jib[i] = 0;
  return turned(jib, slew_rad);
}

/// Adds the mean balance of the last kMeanSamples samples to the sum, reduced by the tolerances.
void add(const Limits& limits, double cable_m, double slew_rad, double span_s, PendulumMemory& memory) {
  Plane error{}, swing_change{};
  for (const auto& balance : memory.balances) {
    error = error + (1.0 / kMeanSamples) * balance.error_mps;
    swing_change = swing_change + (1.0 / kMeanSamples) * balance.swing_change_mps;
  }
  error = measured(limits, error, slew_rad);
  memory.swing_change_mps = static_cast<double>(kMeanSamples) * swing_change;
  const auto& [newest, middle, oldest] = memory.recent;
  const double swing_mps =
      norm((1 / (newest.sampled_s - oldest.sampled_s)) * (newest.load_offset_m - oldest.load_offset_m));
  const double omega_radps = plant::swing_radps(limits.machine.crane.gravity_mps2, cable_m);
  const double unknown =
      pendulum_drift(limits, span_s) + 2 * kDampingRatio * omega_radps * swing_mps * span_s;
  const Plane sum =
      shortened_along(swing_change, kCableTolerance * norm(swing_change), memory.sum_mps + error);
  const double length = norm(sum);
  memory.sum_mps = length > unknown ? (1 - unknown / length) * sum : Plane{};
  memory.growing_samples = length > unknown ? std::min(memory.growing_samples + 1, kPush_samples + 1) : 0;
}

/// Limit of the sum, m/s. @param position  of the axes @param span_s  time between two samples
double pendulum_limit(const Limits& limits, const PerAxis& position, double span_s) noexcept {
  const auto& swing = limits.machine.swing_resolution_rad;
  const auto& axis = limits.machine.resolution;
  const double load_m = limits.machine.cable(position[2]) * std::hypot(swing[0], swing[1]);
  const double pivot_m = std::hypot(axis[0], position[0] * axis[1]);
  return kPermittedSum_mps + 2 * (load_m + pivot_m) / (static_cast<double>(kMeanSamples) * span_s);
}

/// @return true when an encoder that counted before the push has not counted for kNoCount_samples
///   consecutive samples after the push
bool follow_counts(const Limits& limits, const PendulumInput& input, double span_s, PendulumMemory& memory) {
  bool stopped = false;
  const std::array<double, 2> swing_rad{input.radial_rad, input.tangential_rad};
  // A filtered angle changes in every sample by a part of a count.
  const double least_counts = limits.machine.swing_filtered ? 0.5 / kNoCount_samples : 0.5;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool no_count =
        std::abs(swing_rad[i] - memory.swing_rad[i]) <= least_counts * limits.machine.swing_resolution_rad[i];
    memory.swing_rad[i] = swing_rad[i];
    memory.counting_samples[i] = no_count ? std::max(memory.counting_samples[i] - 1, 0) : 2 * kPush_samples;
    memory.no_count_samples[i] = no_count && memory.push_left_s > 0 ? memory.no_count_samples[i] + 1 : 0;
    stopped = stopped || (memory.counted_before_push[i] && memory.no_count_samples[i] >= kNoCount_samples);
  }
  memory.push_left_s -= span_s;
  return stopped;
}

/// @return true when a tolerated push explains the sum; clears the sum
bool was_pushed(PendulumMemory& memory) {
  constexpr double kLeastShareOfSum = 0.5;
  const double length = norm(memory.sum_mps);
  // A push explains the sum only when both have the same direction.
  const double swing_change = dot(memory.swing_change_mps, memory.sum_mps) / length;
  if (memory.push_left_s > 0 || memory.growing_samples > kPush_samples ||
      !(swing_change >= kLeastShareOfSum * length))
    return false;
  memory.push_left_s = kPushInterval_s;
  for (std::size_t i = 0; i < 2; ++i) memory.counted_before_push[i] = memory.counting_samples[i] > 0;
  memory.sum_mps = {};
  memory.balances = {};
  memory.growing_samples = 0;
  memory.samples = 0;
  return true;
}

}  // namespace

double pendulum_drift(const Limits& limits, double span_s) noexcept {
  return (limits.machine.crane.gravity_mps2 * kZeroError_rad + limits.clearance.wind_mps2) * span_s;
}

bool swing_sensor_failed(const Limits& limits, const PendulumInput& input, PendulumMemory& memory) noexcept {
  const auto& machine = limits.machine;
  if (!machine.known || !(machine.swing_measured[0] || machine.swing_measured[1])) return false;
  const double elapsed_s = memory.samples > 0 ? input.sampled_s - memory.recent[0].sampled_s : kLongestGap_s;
  const double shortest_s = shortest_span_s(limits, machine.cable(input.position[2]));
  if (memory.samples > 0 && !(elapsed_s > 0 && elapsed_s >= shortest_s - kSameTick * limits.period_s))
    return false;
  if (elapsed_s > kLongestGap_s + shortest_s) memory = {.largest = memory.largest};
  memory.recent[2] = memory.recent[1];
  memory.recent[1] = memory.recent[0];
  const PerAxis position = filtered(limits, input, memory);
  memory.recent[0] = past_sample(limits, input, position);
  memory.samples = std::min(memory.samples + 1, kMeanSamples + 2);
  if (memory.samples < 3) return false;
  memory.balances[memory.next] = balance_of(limits, memory);
  memory.next = (memory.next + 1) % kMeanSamples;
  if (memory.samples < kMeanSamples + 2 || memory.filter_ticks_left > 0) return false;
  const double cable_m = machine.cable(position[2]);
  const double span_s = (memory.recent[0].sampled_s - memory.recent[2].sampled_s) / 2;
  add(limits, cable_m, position[1], span_s, memory);
  const double ratio = norm(memory.sum_mps) / pendulum_limit(limits, position, span_s);
  if (follow_counts(limits, input, span_s, memory)) return true;
  if (ratio > 1 && was_pushed(memory)) return false;
  memory.largest = std::max(memory.largest, ratio);
  return !(ratio <= 1);
}

}  // namespace crane::supervisor
