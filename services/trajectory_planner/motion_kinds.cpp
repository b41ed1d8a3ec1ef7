#include "trajectory_planner/motion_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crane::services {

using control::kAxes;

control::Reference Profiles::at(double time_s) const noexcept {
  auto reference = control::reference_at(trajectory, time_s);
  for (const auto axis : {control::kTrolley, control::kSlew})
    reference[axis] = shaper.at(trajectory[axis], time_s);
  if (excitation) reference[excitation->axis] = excitation->at(time_s);
  return reference;
}

double Profiles::duration_s() const noexcept {
  return excitation ? excitation->duration_s : control::duration_s(trajectory) + shaper.delay_s();
}

control::Reference AroundZones::at(double time_s) const noexcept {
  control::Reference reference;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const control::RouteOfAxis axis{route, i};
    reference[i] = i == control::kHoist ? axis.at(time_s) : shaper.at(axis, time_s);
  }
  return reference;
}

control::Reference Planned::at(double time_s) const noexcept {
  return control::reference_at(*design, problem, plan, time_s);
}

control::Reference Creeping::at(double time_s) const noexcept {
  control::Reference reference;
  for (std::size_t i = 0; i < kAxes; ++i)
    reference[i] = {.position = start[i] + speed[i] * time_s, .speed = speed[i], .acceleration = 0};
  return reference;
}

double Creeping::duration_s() const noexcept { return std::numeric_limits<double>::infinity(); }

double Braking::Axis::duration_s() const noexcept { return std::abs(speed) / deceleration; }

control::AxisReference Braking::Axis::at(double time_s) const noexcept {
  const double direction = speed < 0 ? -1 : 1;
  const double t = std::clamp(time_s, 0.0, duration_s());
  const bool rests = time_s >= duration_s();
  return {.position = start + speed * t - direction * deceleration * t * t / 2,
          .speed = rests ? 0 : speed - direction * deceleration * t,
          .acceleration = rests ? 0 : -direction * deceleration};
}

control::Reference Braking::at(double time_s) const noexcept {
  control::Reference reference;
  for (std::size_t i = 0; i < kAxes; ++i) reference[i] = axis[i].at(time_s);
  return reference;
}

double Braking::duration_s() const noexcept {
  double longest_s = 0;
  for (const Axis& one : axis) longest_s = std::max(longest_s, one.duration_s());
  return longest_s;
}

}  // namespace crane::services
