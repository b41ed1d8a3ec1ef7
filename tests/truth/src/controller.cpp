#include "controller.hpp"

#include <algorithm>
#include <cmath>

namespace truth {
namespace {

constexpr double kFilter = 0.35;  // filter constant of the differentiated measurement, per tick
constexpr double kDamping = 0.8;
// share of the friction that the controller compensates
constexpr double kBelievedCoulomb = 0.85, kBelievedViscous = 0.9;
constexpr double kMost_v = 9.5;

}  // namespace

Controller::Controller(const Physics& nominal, const Plan& plan) : nominal_(nominal), plan_(plan) {
  ramps_[0].held_at = plan.start.trolley_m;
  ramps_[1].held_at = plan.start.slew_rad;
  ramps_[1].since_s = 0.9;
}

double Controller::gain(std::size_t axis, const Sensed& measured) const {
  if (axis == 0) return nominal_.drive[0].gain;
  const double turning = (nominal_.carriage_kg + nominal_.load_kg) * measured[0] * measured[0];
  return nominal_.drive[1].gain / (1 + turning / nominal_.jib_kgm2);
}

double Controller::track(std::size_t axis, const Target& target, const Sensed& measured) const {
  const Drive& d = nominal_.drive[axis];
  const double w = nominal_.bandwidth_radps[axis];
  double acceleration = target.acceleration + w * w * (target.position - measured[axis]) +
                        2 * kDamping * w * (target.speed - rate_[axis]);
  // The loop is faster than the swing. Therefore a shift of the reference, r = k phi' / w_0^2, damps the
  // swing.
  const double shift = w * w * plan_.swing_damping * plan_.cable_m / nominal_.gravity_mps2;
  if (axis == 0) acceleration += shift * rate_[2];
  if (axis == 1) acceleration -= shift * rate_[3] / std::max(0.3, measured[0]);
  const std::size_t side = target.speed < 0 ? 1 : 0;
  const double friction = kBelievedCoulomb * d.coulomb_v[side] * std::tanh(target.speed / 0.01) +
                          kBelievedViscous * d.viscous_vs[side] * target.speed;
  return acceleration / gain(axis, measured) + friction;
}

/// The voltage rises until the axis has moved and is then constant for a second; the directions alternate.
double Controller::ramp(std::size_t axis, const Sensed& measured, double time_s) {
  constexpr double kRise_vps = 0.9, kMoved = 0.004, kHold_s = 1.2, kRest_s = 0.4;
  Ramp& r = ramps_[axis];
  if (r.holding) {
    if (time_s < r.since_s + kHold_s) return track(axis, {r.held_at, 0, 0}, measured);
    if (time_s < r.since_s + kHold_s + kRest_s) return 0;
    r = {time_s, -r.direction, measured[axis], false};
  }
  if (time_s < r.since_s) return 0;
  if (std::abs(measured[axis] - r.held_at) > kMoved) {
    r.holding = true;
    r.since_s = time_s;
    r.held_at = measured[axis];
    return 0;
  }
  return r.direction * kRise_vps * (time_s - r.since_s);
}

Volts Controller::step(const Sensed& measured, double time_s) {
  if (first_) last_ = measured;
  first_ = false;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    rate_[i] += kFilter * ((measured[i] - last_[i]) / kTick_s - rate_[i]);
    last_[i] = measured[i];
  }
  Volts v{};
  for (std::size_t axis = 0; axis < kDrives; ++axis) {
    if (!nominal_.drive[axis].present) continue;
    v[axis] = plan_.break_away ? ramp(axis, measured, time_s)
                               : track(axis, plan_.reference[axis].at(time_s + kTick_s), measured);
    v[axis] = std::clamp(v[axis], -kMost_v, kMost_v);
  }
  return v;
}

}  // namespace truth
