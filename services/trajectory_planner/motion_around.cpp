/// Motion around zones: following a path, and slowing down before the next path begins.
#include <algorithm>
#include <cmath>

#include "crane/plant/pendulum.hpp"
#include "trajectory_planner/motion.hpp"

namespace crane::services {

using control::kAxes;

void Motion::start(const control::Path& path, const control::PathSpace& space, std::uint64_t tick) {
  const auto now = at(tick);
  plant::PerAxis start{};
  for (std::size_t i = 0; i < kAxes; ++i) start[i] = now[i].position;
  // Every reference is shaped, because a leg begins before the law has damped the swing of the previous leg.
  // ZV is not sufficient: it does not cancel the swing by the Coriolis force of a trolley on a turning jib.
  const bool shapes = shape_ != control::ReferenceShape::step;
  const auto shaping = shaping_ == control::Shaping::ei ? shaping_ : control::Shaping::zvd;
  const auto shaper =
      shapes ? this->shaper(shaping, path.points.front().position[control::kHoist]) : control::Shaper{};
  active_ = AroundZones{{space, start, path.points, route_style(shaper)}, shaper};
  begin_at(tick);
}

control::RouteStyle Motion::route_style(const control::Shaper& shaper) const noexcept {
  // A law for step references ignores the speed of the reference: the axes lag by different amounts and would
  // leave the legs at a corner. The delay lets them arrive before the next leg.
  constexpr double kLag_s = 3, kSlowerForLag = 0.5;
  if (shape_ == control::ReferenceShape::step) return {.delay_s = kLag_s, .speed_factor = kSlowerForLag};
  return {.blends = true, .overlaps = !(shaper.delay_s() > 0), .delay_s = shaper.delay_s()};
}

double Motion::rate(std::uint64_t tick) const noexcept {
  if (!slowing_) return 1;
  const double passed_s = static_cast<double>(tick - start_tick_) * rig_.period_s;
  return std::clamp(1 - (passed_s - slowing_->begin_s) / slowing_->duration_s, 0.0, 1.0);
}

control::Reference Motion::at(std::uint64_t tick) const noexcept {
  control::Reference reference = on_path(tick);
  if (!slowing_) return reference;
  const double rate = this->rate(tick), change = rate > 0 && rate < 1 ? -1 / slowing_->duration_s : 0;
  for (auto& axis : reference) {
    axis.acceleration = axis.acceleration * rate * rate + axis.speed * change;
    axis.speed *= rate;
  }
  for (double& volts : reference.feed_forward_v) volts *= rate;
  auto& swing = reference.swing;
  for (double* value :
       {&swing.radial_rad, &swing.radial_radps, &swing.tangential_rad, &swing.tangential_radps})
    *value *= rate;
  return reference;
}

std::uint64_t Motion::slow_down(std::uint64_t tick) noexcept {
  const auto now = at(tick);
  double longest_s = 0;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (now[i].speed != 0)
      longest_s = std::max(longest_s, std::abs(now[i].speed) / rig_.drives[i].reference_acceleration);
  if (!(longest_s > 0) || std::holds_alternative<Stick>(active_) || slowing_) return tick;
  // A constant deceleration for exactly one swing period leaves no swing.
  const double period_s =
      plant::swing_period_s(rig_.design.crane.gravity_mps2, std::max(now[control::kHoist].position, 0.05));
  slowing_ = Slowing{time_s(tick), std::max(longest_s, period_s)};
  return tick + static_cast<std::uint64_t>(std::ceil(slowing_->duration_s / rig_.period_s));
}

bool Motion::rests(const control::Measurement& measured, std::uint64_t tick) const noexcept {
  constexpr double kBand = 0.02, kSlow = 0.02;  // m, rad; m/s, rad/s
  if (!reference_rests(tick)) return false;
  const auto reference = at(tick);
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig_.drives[i].present && (std::abs(measured.speed[i]) > kSlow ||
                                   std::abs(measured.position[i] - reference[i].position) > kBand))
      return false;
  return true;
}

}  // namespace crane::services
