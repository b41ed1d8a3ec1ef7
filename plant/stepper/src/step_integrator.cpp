#include "crane/stepper/step_integrator.hpp"

#include <algorithm>
#include <cmath>

#include "crane/stepper/friction_step.hpp"

namespace crane::stepper {

using plant::State;

int steps_in(double period_s, bool inner_coordinates) {
  constexpr double kLongestStep_s = 0.005, kLongestInnerStep_s = 0.0025;
  const double longest_s = inner_coordinates ? kLongestInnerStep_s : kLongestStep_s;
  return std::max(1, static_cast<int>(std::ceil(period_s / longest_s - 1e-9)));
}

StepIntegrator::StepIntegrator(const plant::Model& model, const std::array<bool, kOutputs>& simulated,
                               const plant::Locks& locks, double step_s)
    : model_(model), simulated_(simulated), h_(step_s) {
  actuation_.locks = locks;
}

void StepIntegrator::new_command(const plant::PerAxis& drive_v) {
  actuation_.drive_v = drive_v;
  gains_known_ = false;
}

void StepIntegrator::step(const MeasuredKinematics& at) {
  const State middle = mid_step(at);
  plant::InnerState inner_middle = inner;
  for (std::size_t i = 0; i < model_.inner_coordinates(); ++i) {
    inner_middle[i].position += 0.5 * h_ * inner[i].rate;
    inner_middle[i].rate += 0.5 * h_ * last_inner_[i];
  }
  plant::InnerAccelerations inner_acceleration{};
  actuation_.prescribed = prescribed;
  prescribe_inner(inner_middle, inner_acceleration);
  plant::ModelEquations equations = model_.equations(middle, actuation_, {}, inner_middle);
  if (simulated_[kTrolleyPosition] || simulated_[kSlewAngle])
    model_.add_friction(move_drives(middle, inner_middle, equations), equations);
  if (simulated_[kRadialSwing] || simulated_[kTangentialSwing] || model_.inner_coordinates() > 0) {
    const plant::Accelerations a = model_.solution(equations, actuation_, inner_acceleration);
    for (const Output swing : {kRadialSwing, kTangentialSwing})
      if (simulated_[swing]) kick(swing, acceleration_of(a, swing));
    kick_inner(inner_acceleration);
  }
}

plant::Accelerations StepIntegrator::accelerations(const MeasuredKinematics& at) {
  const State there = mid_step(at);
  plant::InnerAccelerations ignored{};
  return model_.accelerations(there, actuation_, model_.friction_v(there, actuation_.drive_v), inner,
                              ignored);
}

void StepIntegrator::prescribe(const MeasuredKinematics& at) {
  for (const Output output : kAllOutputs) {
    if (simulated_[output]) continue;
    position_of(state, output) = at.output[output].position;
    rate_of(state, output) = at.output[output].rate;
  }
  state.cable_m = at.cable.position;
  state.cable_mps = at.cable.rate;
}

State StepIntegrator::mid_step(const MeasuredKinematics& at) {
  State middle = state;
  for (const Output output : kAllOutputs) {
    if (simulated_[output]) {
      position_of(middle, output) += 0.5 * h_ * rate_of(state, output);
      rate_of(middle, output) += 0.5 * h_ * last_[output];
    } else {
      position_of(middle, output) = at.output[output].position;
      rate_of(middle, output) = at.output[output].rate;
    }
  }
  middle.cable_m = at.cable.position;
  middle.cable_mps = at.cable.rate;
  actuation_.locks.acceleration = {at.output[kTrolleyPosition].acceleration,
                                   at.output[kSlewAngle].acceleration, at.cable.acceleration};
  return middle;
}

void StepIntegrator::kick(Output output, double acceleration) {
  double& rate = rate_of(state, output);
  const double before = rate;
  rate += h_ * acceleration;
  position_of(state, output) += 0.5 * h_ * (before + rate);
  last_[output] = acceleration;
}

void StepIntegrator::prescribe_inner(plant::InnerState& inner_middle,
                                     plant::InnerAccelerations& accelerations) const {
  for (std::size_t i = 0; i < model_.inner_coordinates(); ++i) {
    if (!prescribed[i]) continue;
    inner_middle[i] = {prescribed_at[i].position, prescribed_at[i].rate};
    accelerations[i] = prescribed_at[i].acceleration;
  }
}

void StepIntegrator::kick_inner(const plant::InnerAccelerations& accelerations) {
  for (std::size_t i = 0; i < model_.inner_coordinates(); ++i) {
    const double before = inner[i].rate;
    inner[i].rate += h_ * accelerations[i];
    inner[i].position += 0.5 * h_ * (before + inner[i].rate);
    last_inner_[i] = accelerations[i];
  }
}

plant::PerAxis StepIntegrator::move_drives(const State& middle, const plant::InnerState& inner_middle,
                                           const plant::ModelEquations& without_friction) {
  plant::InnerAccelerations ignored{};
  const plant::Accelerations a = model_.solution(without_friction, actuation_, ignored);
  const plant::PerAxis free{a.trolley_mps2, a.slew_radps2, 0};
  if (!gains_known_) gain_ = model_.friction_response(middle, actuation_.locks, inner_middle);
  gains_known_ = true;
  plant::PerAxis friction = last_friction_;
  for (const Output axis : {kTrolleyPosition, kSlewAngle}) {
    if (!simulated_[axis]) continue;
    const std::size_t other = 1 - axis;
    const double driving = free[axis] - (simulated_[other] ? gain_[axis][other] * friction[other] : 0);
    State moving = middle;
    const auto friction_at = [&](double speed) {
      rate_of(moving, axis) = speed;
      return model_.friction_v(moving, actuation_.drive_v[axis], static_cast<plant::Axis>(axis));
    };
    const FrictionStep done =
        friction_step(rate_of(state, axis), driving, gain_[axis][axis], h_, friction_at);
    friction[axis] = done.friction;
    last_[axis] = (done.speed - rate_of(state, axis)) / h_;
    rate_of(state, axis) = done.speed;
    position_of(state, axis) += done.distance;
  }
  last_friction_ = friction;
  return friction;
}

}  // namespace crane::stepper
