#include "crane/control/stick.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "crane/plant/pendulum.hpp"
#include "require.hpp"

namespace crane::control {
namespace {

/// Impulses of the shaper for a swing period of 2 `half_ticks`.
ShaperImpulses impulses_of(Shaping shaping, std::size_t half_ticks, double period_s) noexcept {
  const double swing_period_s = 2 * static_cast<double>(half_ticks) * period_s;
  const Shaper shaper{shaping, swing_period_s};
  ShaperImpulses impulses{.impulse = {}, .count = 0, .mean_s = 0, .largest_weight = 0};
  for (const Impulse& impulse : shaper.impulses()) {
    const auto halves = static_cast<std::size_t>(std::lround(2 * impulse.time_s / swing_period_s));
    impulses.impulse[impulses.count++] = {halves * half_ticks, impulse.weight};
    impulses.mean_s += impulse.weight * impulse.time_s;
    impulses.largest_weight = std::max(impulses.largest_weight, impulse.weight);
  }
  return impulses;
}

/// Largest change of speed in one tick, unit/s, and duration of the tick.
struct RateLimit {
  double change, period_s;
};

/// The change nearest to `wanted` with which no tick exceeds the acceleration limit.
double feasible(double wanted, const ShaperImpulses& impulses, const RateLimit& rate,
                const PendingChanges& pending) noexcept {
  double low = -1e9, high = 1e9;
  for (std::size_t i = 0; i < impulses.count; ++i) {
    const auto& [ticks, weight] = impulses.impulse[i];
    low = std::max(low, (-rate.change - pending.in(ticks)) / weight);
    high = std::min(high, (rate.change - pending.in(ticks)) / weight);
  }
  // Rounding may raise the change in a tick above the limit by one unit of the last bit.
  return std::clamp(wanted, std::min(low, 0.0), std::max(high, 0.0));
}

/// Advances u and s by one tick.
void advance(const ShaperImpulses& impulses, const RateLimit& rate, double wanted, StickAxis& axis) noexcept {
  if (wanted != axis.unshaped) {
    const double change = feasible(wanted - axis.unshaped, impulses, rate, axis.pending);
    for (std::size_t i = 0; i < impulses.count; ++i) {
      const auto& [ticks, weight] = impulses.impulse[i];
      axis.pending.add(ticks, weight * change);
      axis.lag += weight * change * static_cast<double>(ticks) * rate.period_s;
    }
    const double left = wanted - axis.unshaped - change;
    axis.unshaped = std::abs(left) < 1e-12 ? wanted : axis.unshaped + change;
  }
  const double before = axis.speed;
  axis.speed += axis.pending.take();
  if (axis.pending.empty()) {  // removes the rounding errors of the sums
    axis.speed = axis.unshaped;
    axis.lag = 0;
  }
  axis.position += (before + axis.speed) / 2 * rate.period_s;
  axis.acceleration = (axis.speed - before) / rate.period_s;
  axis.lag -= (axis.unshaped - axis.speed) * rate.period_s;
}

PositionRange release_of(const ShaperImpulses& impulses, const RateLimit& rate, StickAxis axis) noexcept {
  PositionRange range{axis.position, axis.position};
  while (axis.unshaped != 0 || !axis.pending.empty()) {
    advance(impulses, rate, 0, axis);
    range.low = std::min(range.low, axis.position);
    range.high = std::max(range.high, axis.position);
  }
  return range;
}

/// Positions of a stop. If no stop can reach a limit, the function returns only the present position.
PositionRange release_in(const StickAxisLimits& limits, const ShaperImpulses& impulses, const RateLimit& rate,
                         const StickAxis& axis) noexcept {
  const double delay_s = static_cast<double>(impulses.impulse[impulses.count - 1].ticks) * rate.period_s;
  const double longest = limits.speed * (2 * limits.speed / limits.acceleration + 2 * delay_s);
  if (axis.position - longest > limits.low && axis.position + longest < limits.high)
    return {axis.position, axis.position};
  return release_of(impulses, rate, axis);
}

/// Largest u >= 0 whose stop needs at most `distance`: u^2 / (2 b) + u m = distance, with the
/// deceleration b of u and the mean delay m of the shaper.
double speed_for(double distance, double braking, double mean_s) noexcept {
  if (!(distance > 0)) return 0;
  return braking * (std::sqrt(mean_s * mean_s + 2 * distance / braking) - mean_s);
}

void step_axis(const StickAxisLimits& limits, const ShaperImpulses& impulses, double period_s, double wanted,
               StickAxis& axis) noexcept {
  if (!(limits.speed > 0)) return;
  const RateLimit rate{limits.acceleration * period_s, period_s};
  const double braking = limits.acceleration / impulses.largest_weight, tick_travel = limits.speed * period_s;
  // position at the end of the pending changes, without the braking distance from u
  const double end = axis.position - axis.lag;
  const double up = speed_for(limits.high - end - tick_travel, braking, impulses.mean_s);
  const double down = speed_for(end - limits.low - tick_travel, braking, impulses.mean_s);
  StickAxis trial = axis;
  advance(impulses, rate, std::clamp(wanted, -down, up), trial);
  trial.release = release_in(limits, impulses, rate, trial);
  const bool inside = trial.release.low >= std::min(limits.low, axis.release.low) &&
                      trial.release.high <= std::max(limits.high, axis.release.high);
  if (!inside) {
    trial = axis;
    advance(impulses, rate, 0, trial);
    trial.release = release_in(limits, impulses, rate, trial);
  }
  axis = trial;
}

/// Exact solution of e'' = -w^2 e - s'' over one tick, with e = q - s and constant s''.
void follow(double frequency_radps, double period_s, StickAxis& axis) noexcept {
  const double c = std::cos(frequency_radps * period_s), s = std::sin(frequency_radps * period_s);
  const double shift = axis.acceleration / (frequency_radps * frequency_radps);
  const double from = axis.load_offset + shift, rate = axis.load_offset_rate;
  axis.load_offset = from * c + rate / frequency_radps * s - shift;
  axis.load_offset_rate = rate * c - from * frequency_radps * s;
  constexpr double kRounding = 1e-9;  // m, rad: a smaller offset of a load at rest is a rounding error
  const bool rests = axis.speed == 0 && axis.unshaped == 0 && axis.pending.empty();
  if (rests && std::abs(axis.load_offset) < kRounding && std::abs(axis.load_offset_rate) < kRounding)
    axis.load_offset = axis.load_offset_rate = 0;
}

/// Motion of a load coordinate.
struct Load {
  double position, speed, acceleration;
};
Load load_of(const StickAxis& axis, double frequency_radps) noexcept {
  return {axis.position + axis.load_offset, axis.speed + axis.load_offset_rate,
          -frequency_radps * frequency_radps * axis.load_offset};
}

StickPoint point_of(const StickLimits& limits, const StickMemory& memory) noexcept {
  const auto& [trolley, slew, hoist] = memory.axis;
  StickPoint point{.position = {trolley.position, slew.position, hoist.position}};
  if (limits.shaping == Shaping::none) return point;
  const Load r = load_of(trolley, memory.frequency_radps), a = load_of(slew, memory.frequency_radps);
  const double per_acceleration = hoist.position / limits.gravity_mps2;
  // P - y in the frame of the load, along its radius and across it
  const double along = per_acceleration * (r.acceleration - r.position * a.speed * a.speed);
  const double across = per_acceleration * (2 * r.speed * a.speed + r.position * a.acceleration);
  const double turn = std::atan2(across, r.position + along);
  point.position[kTrolley] = std::hypot(r.position + along, across);
  point.position[kSlew] = a.position + turn;
  // y - P in the frame of the jib
  const double out = -along * std::cos(turn) - across * std::sin(turn);
  const double ahead = along * std::sin(turn) - across * std::cos(turn);
  point.tangential_rad = std::asin(std::clamp(ahead / hoist.position, -1.0, 1.0));
  const double down = std::sqrt(std::max(hoist.position * hoist.position - out * out - ahead * ahead, 1e-12));
  point.radial_rad = std::atan2(-out, down);
  return point;
}

constexpr int kPathTicks = 4;  // number of equal points of a path at rest

bool s_at_rest(const StickMemory& memory) noexcept {
  return std::ranges::all_of(memory.axis, [](const StickAxis& axis) {
    return axis.speed == 0 && axis.unshaped == 0 && axis.pending.empty();
  });
}

/// Limits of s: those of P minus the additional motion of P by slewing and hoisting, which
/// tests/control/stick_test.cpp measures for random histories.
std::array<StickAxisLimits, kAxes> limits_of_s(const StickLimits& limits,
                                               const Reference& reference) noexcept {
  constexpr double kHoisting = 0.9;               // limits of s / limits of P in a session with hoisting
  constexpr double kSlewing = 0.5;                // limits of s / limits of P in a session with slewing
  constexpr double kMostCentrifugalShare = 0.08;  // largest r gamma'^2 / acceleration limit of the trolley
  constexpr double kRoom = 0.02;                  // distance between the radial limits of s and P / radius
  constexpr double kTurn = 0.05;                  // distance between the slew limits of s and P, rad
  auto axis = limits.axis;
  const auto scale = [&axis](std::size_t i, double share) {
    axis[i].speed *= share;
    axis[i].acceleration *= share;
  };
  if (limits.shaping == Shaping::none) return axis;
  if (axis[kHoist].speed > 0) scale(kTrolley, kHoisting), scale(kSlew, kHoisting);
  if (!(axis[kSlew].speed > 0) || !(axis[kTrolley].acceleration > 0)) return axis;
  const double radius_m =
      std::max(limits.axis[kTrolley].speed > 0 ? axis[kTrolley].high : 0.0, reference[kTrolley].position);
  const double centrifugal_mps2 = kMostCentrifugalShare * limits.axis[kTrolley].acceleration;
  scale(kTrolley, kSlewing), scale(kSlew, kSlewing);
  axis[kSlew].speed = std::min(axis[kSlew].speed, std::sqrt(centrifugal_mps2 / std::max(radius_m, 1e-3)));
  axis[kSlew].low += kTurn;
  axis[kSlew].high -= kTurn;
  axis[kTrolley].low += kRoom * std::abs(axis[kTrolley].low);
  axis[kTrolley].high -= kRoom * std::abs(axis[kTrolley].high);
  return axis;
}

double usable(double wanted, double limit) noexcept {
  return std::isfinite(wanted) ? std::clamp(wanted, -limit, limit) : 0;
}

}  // namespace

PendingChanges& PendingChanges::operator=(const PendingChanges& other) noexcept {
  if (this == &other) return *this;
  first_ = 0;
  count_ = other.count_;
  for (std::size_t i = 0; i < count_; ++i) slot_[i] = other.in(i);
  return *this;
}

void PendingChanges::add(std::size_t ticks, double change) noexcept {
  while (count_ <= ticks) slot_[(first_ + count_++) % kStickSlots] = 0;
  slot_[(first_ + ticks) % kStickSlots] += change;
}

double PendingChanges::take() noexcept {
  if (count_ == 0) return 0;
  const double change = slot_[first_];
  first_ = (first_ + 1) % kStickSlots;
  --count_;
  return change;
}

std::vector<std::string> problems(const StickLimits& limits) {
  Requirements rules;
  rules.above_up_to("period_s", limits.period_s, 0, 1);
  rules.above_up_to("gravity_mps2", limits.gravity_mps2, 0, 1e3);
  rules.above_up_to("longest_cable_m", limits.longest_cable_m, 0, 1e3);
  const double longest_s = plant::swing_period_s(limits.gravity_mps2, limits.longest_cable_m);
  rules.require(longest_s <= (kStickSlots - 3) * limits.period_s, "period_s", limits.period_s,
                "the swing period of the longest cable must have at most 4093 ticks");
  for (const auto& axis : limits.axis) {
    rules.in_range("speed", axis.speed, 0, 1e3);
    rules.in_range("low", axis.low, -1e9, axis.high);
    if (axis.speed > 0) rules.above_up_to("acceleration", axis.acceleration, 0, 1e3);
  }
  return rules.found;
}

void begin(const StickLimits& limits, const Reference& reference, StickMemory& memory) noexcept {
  const double longest_m = std::max(limits.longest_cable_m, reference[kHoist].position);
  const double half_s = plant::swing_period_s(limits.gravity_mps2, longest_m) / 2;
  const auto half_ticks = static_cast<std::size_t>(std::ceil(half_s / limits.period_s));
  memory.impulses = impulses_of(limits.shaping, std::min(half_ticks, kStickSlots / 2 - 1), limits.period_s);
  memory.frequency_radps = std::numbers::pi / (static_cast<double>(half_ticks) * limits.period_s);
  memory.limits = limits_of_s(limits, reference);
  for (std::size_t i = 0; i < kAxes; ++i) {
    StickAxis& axis = memory.axis[i];
    axis.position = reference[i].position;
    axis.speed = axis.unshaped = axis.acceleration = axis.lag = 0;
    axis.load_offset = axis.load_offset_rate = 0;
    axis.pending = {};
    axis.release = {axis.position, axis.position};
  }
  memory.path.fill(point_of(limits, memory));
  memory.rest_ticks = 0;
}

Reference step(const StickLimits& limits, const std::array<double, kAxes>& wanted,
               StickMemory& memory) noexcept {
  for (const std::size_t i : {kTrolley, kSlew, kHoist})
    step_axis(memory.limits[i], i == kHoist ? ShaperImpulses{} : memory.impulses, limits.period_s,
              usable(wanted[i], memory.limits[i].speed), memory.axis[i]);
  for (const std::size_t i : {kTrolley, kSlew})
    follow(memory.frequency_radps, limits.period_s, memory.axis[i]);
  memory.rest_ticks = s_at_rest(memory) ? std::min(memory.rest_ticks + 1, kPathTicks) : 0;
  std::shift_right(memory.path.begin(), memory.path.end(), 1);
  memory.path[0] = point_of(limits, memory);

  const auto& [newest, next, now, before] = memory.path;
  const double h = limits.period_s;
  Reference reference;
  for (std::size_t i = 0; i < kAxes; ++i)
    reference[i] = {.position = now.position[i],
                    .speed = (next.position[i] - before.position[i]) / (2 * h),
                    .acceleration = (next.position[i] - 2 * now.position[i] + before.position[i]) / (h * h)};
  reference.swing = {.radial_rad = next.radial_rad,
                     .radial_radps = (newest.radial_rad - now.radial_rad) / (2 * h),
                     .tangential_rad = next.tangential_rad,
                     .tangential_radps = (newest.tangential_rad - now.tangential_rad) / (2 * h)};
  return reference;
}

bool at_rest(const StickMemory& memory) noexcept { return memory.rest_ticks == kPathTicks; }

}  // namespace crane::control
