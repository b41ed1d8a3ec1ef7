#include "crane/twin/predictor.hpp"

#include <cmath>

namespace crane::twin {
namespace {

PerColumn columns_of(const plant::Measurement& m) {
  return {m.trolley_m, m.slew_rad, m.radial_rad, m.tangential_rad};
}

}  // namespace

Predictor::Predictor(const plant::Parameters& parameters, const std::vector<plant::TermSetting>& terms,
                     double period_s, double horizon_s, const PerColumn& slip)
    : model_(std::make_unique<plant::Model>(parameters, terms, period_s)), slip_(slip) {
  const double rho = std::exp(-period_s / horizon_s);
  position_gain_ = 1 - rho * rho;
  rate_gain_ = (1 - rho) * (1 - rho) / period_s;
  steps_ = stepper::steps_in(period_s, model_->inner_coordinates() > 0);
  step_s_ = period_s / steps_;
}

void Predictor::restart(const MeasuredTick& now, const Mask& simulated) {
  simulated_ = simulated;
  plant::Locks locks;
  locks.axis = {!simulated[stepper::kTrolleyPosition], !simulated[stepper::kSlewAngle], true};
  locks.radial = !simulated[stepper::kRadialSwing];
  locks.tangential = !simulated[stepper::kTangentialSwing];
  integrator_.emplace(*model_, simulated, locks, step_s_);
  integrator_->prescribe({given(now), {now.cable_m, now.cable_mps, 0}});
  for (const auto column : stepper::kAllOutputs)
    if (simulated[column]) position_of(integrator_->state, column) = now.reported[column];
  // Inverts the sensor terms to first order in the sensor errors.
  const PerColumn seen = columns_of(model_->measure(integrator_->state));
  for (const auto column : stepper::kAllOutputs) {
    if (!simulated[column]) continue;
    position_of(integrator_->state, column) += now.reported[column] - seen[column];
    rate_of(integrator_->state, column) = now.rate[column];
  }
  before_ = now;
  predicted_ = now.reported;
}

std::array<stepper::Kinematics, kColumns> Predictor::given(const MeasuredTick& now) const {
  std::array<stepper::Kinematics, kColumns> kinematics;
  for (std::size_t i = 0; i < kColumns; ++i) kinematics[i].position = now.reported[i];
  return kinematics;
}

const PerColumn& Predictor::predict(const plant::PerAxis& applied_v, const MeasuredTick& now) {
  integrator_->new_command(model_->drive_voltage(applied_v));
  const auto still = given(now);
  const auto cable = [&](double share) {
    return stepper::Kinematics{std::lerp(before_.cable_m, now.cable_m, share),
                               std::lerp(before_.cable_mps, now.cable_mps, share), 0};
  };
  for (int step = 0; step < steps_; ++step) integrator_->step({still, cable((step + 0.5) / steps_)});
  integrator_->prescribe({still, cable(1)});
  for (const auto column : stepper::kAllOutputs)
    position_of(integrator_->state, column) +=
        slip_[column] * std::abs(rate_of(integrator_->state, column)) * step_s_ * steps_;
  before_ = now;
  predicted_ = columns_of(model_->measure(integrator_->state));
  for (std::size_t i = 0; i < kColumns; ++i)
    if (!simulated_[i]) predicted_[i] = now.reported[i];
  return predicted_;
}

void Predictor::correct(const PerColumn& reported) {
  for (const auto column : stepper::kAllOutputs) {
    if (!simulated_[column]) continue;
    const double error = reported[column] - predicted_[column];
    position_of(integrator_->state, column) += position_gain_ * error;
    rate_of(integrator_->state, column) += rate_gain_ * error;
  }
}

}  // namespace crane::twin
