#include "trajectory_planner/motion.hpp"

#include <algorithm>
#include <cmath>

namespace crane::services {

using control::kAxes;

control::AxisReference Motion::Braking::at(double time_s) const noexcept {
  const double direction = speed < 0 ? -1 : 1;
  const double duration_s = std::abs(speed) / deceleration;
  const double t = std::clamp(time_s, 0.0, duration_s);
  const bool rests = time_s >= duration_s;
  return {.position = start + speed * t - direction * deceleration * t * t / 2,
          .speed = rests ? 0 : speed - direction * deceleration * t,
          .acceleration = rests ? 0 : -direction * deceleration};
}

double Motion::time_s(std::uint64_t tick) const noexcept {
  return tick > start_tick_ ? static_cast<double>(tick - start_tick_) * rig_.period_s : 0;
}

void Motion::follow(const control::Measurement& measured, std::uint64_t tick) noexcept {
  is_braking_ = false;
  start_tick_ = tick;
  for (std::size_t i = 0; i < kAxes; ++i)
    trajectory_[i] = control::step_profile(measured.position[i], measured.position[i]);
}

void Motion::start(const MoveTarget& move, std::uint64_t tick) {
  const auto now = at(tick);
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double target = move.selected[i] ? move.target[i] : now[i].position;
    const bool limited = shape_ == control::ReferenceShape::bang_coast_bang || i == control::kHoist;
    trajectory_[i] = limited && target != now[i].position
                         ? control::limited_profile(now[i].position, target,
                                                    {.speed = rig_.drives[i].reference_speed,
                                                     .acceleration = rig_.drives[i].reference_acceleration})
                         : control::step_profile(now[i].position, target);
  }
  trajectory_ = control::synchronised(trajectory_);
  is_braking_ = false;
  start_tick_ = tick;
}

void Motion::stop(const control::Measurement& measured, std::uint64_t tick) noexcept {
  is_braking_ = true;
  start_tick_ = tick;
  for (std::size_t i = 0; i < kAxes; ++i)
    braking_[i] = {.start = measured.position[i],
                   .speed = measured.speed[i],
                   .deceleration = std::max(rig_.drives[i].reference_acceleration, 1e-3)};
}

control::Reference Motion::at(std::uint64_t tick) const noexcept {
  if (!is_braking_) return control::reference_at(trajectory_, time_s(tick));
  control::Reference reference;
  for (std::size_t i = 0; i < kAxes; ++i) reference[i] = braking_[i].at(time_s(tick));
  return reference;
}

bool Motion::arrived(const control::Measurement& measured, std::uint64_t tick) const noexcept {
  constexpr double kBand = 0.01;     // m, rad
  constexpr double kSlow = 0.01;     // per second
  constexpr double kLongest_s = 20;  // friction may hold an axis outside the band for ever
  if (time_s(tick) > control::duration_s(trajectory_) + kLongest_s) return true;
  const auto reference = at(tick);
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!rig_.drives[i].present) continue;
    if (reference[i].speed != 0 || std::abs(measured.position[i] - reference[i].position) > kBand ||
        std::abs(measured.speed[i]) > kSlow)
      return false;
  }
  return time_s(tick) >= control::duration_s(trajectory_);
}

}  // namespace crane::services
