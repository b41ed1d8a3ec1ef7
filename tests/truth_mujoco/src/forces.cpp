/// Forces on the bodies: drives with their friction, forces on the load, flanks of a gap.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "crane.hpp"
#include "friction.hpp"

namespace mujoco_truth {
namespace {

/// Natural frequency of the contact of the flanks of a gap, with the motor at rest, and its damping ratio.
constexpr double kFlank_hz = 25, kFlankDamping = 0.25;
/// Widths of two smoothed steps: friction of the guide inside a gap, and friction of the pivot.
constexpr double kGuide_mps = 1e-3, kPivot_radps = 5e-3;
constexpr double kLeast_v = 1e-3;  ///< lower bound of a friction that is used as a divisor

}  // namespace

double Crane::effective_v(std::size_t axis) const {
  const DriveFault& fault = physics_.drive[axis];
  const double gain = 1 + fault.gain_change - fault.gain_loss_per_minute * std::min(time_s_, 60.0) / 60;
  const double commanded_v = acting_v_[axis] + fault.crosstalk * acting_v_[1 - axis];
  const double left = sign_of(commanded_v) * std::max(0.0, std::abs(commanded_v) - fault.dead_zone_v);
  return gain * left + fault.offset_v;
}

double Crane::drive_force_v(std::size_t axis, double z, double hose, double volts, double time_s) const {
  const Drive& drive = physics_.rig.drive[axis];
  const DriveFault& fault = physics_.drive[axis];
  const auto i = static_cast<std::size_t>(joints_.motor[axis]);
  const double position = data_->qpos[i], speed = data_->qvel[i];
  double level =
      (z > 0 ? drive.coulomb_pos_v + fault.asymmetry_v : drive.coulomb_neg_v - fault.asymmetry_v) +
      fault.coulomb_v +
      fault.tight_v / 2 * (1 + std::cos(kTau * (position - fault.tight_at) / fault.tight_wavelength));
  for (const auto& [from, to, direction] : fault.brake_stretches)
    if (time_s >= from && time_s < to) level += fault.brake_v;
  const double friction =
      std::max(0.0, level) * z +
      ((speed > 0 ? drive.viscous_pos_vspm : drive.viscous_neg_vspm) + fault.viscous_vspm) * speed;
  const double ripple =
      -fault.ripple_v * std::sin(kTau * position / fault.ripple_period + fault.ripple_phase);
  const double vibration =
      fault.vibration_v * std::sin(kTau * fault.vibration_hz * time_s + fault.vibration_phase);
  return volts - friction - ripple + vibration - fault.hose_v * hose;
}

void Crane::apply_drive_forces(const State& state, double time_s, const Disturbance& disturbance,
                               State& out) {
  mjData* d = data_.get();
  const auto nv = static_cast<std::size_t>(model_->nv);
  const auto disturbing = disturbance.drive_v ? disturbance.drive_v(time_s) : std::array<double, kAxes>{};
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (joints_.motor[i] < 0) continue;
    const auto at = static_cast<std::size_t>(joints_.motor[i]);
    const double* inner = &state[2 * nv + kInner * i];
    double* inner_slope = &out[2 * nv + kInner * i];
    const Drive& drive = physics_.rig.drive[i];
    const double lag_s = physics_.drive[i].lag_s, speed = d->qvel[at], effective = effective_v(i);
    const double volts = (lag_s > 0 ? inner[2] : effective) + disturbing[i];
    const double per_volt = drive.inertia_kg * drive.gain_mps2pv;
    d->qfrc_applied[at] += per_volt * drive_force_v(i, inner[0], inner[1], volts, time_s);
    inner_slope[0] = inner_slope[1] = 0;  // wear_bristles
    inner_slope[2] = lag_s > 0 ? (effective - inner[2]) / lag_s : 0;
    if (physics_.law ==
        StandstillLaw::lugre) {  // damping of the bristles, nearly critical, at low speeds only
      const double top = ceiling(i, inner[0], speed), way = physics_.presliding_m;
      const double z_slope = bristle_slope(physics_.law, inner[0], speed, top, way);
      const double newton =
          per_volt * std::max(kLeast_v, inner[0] > 0 ? drive.coulomb_pos_v : drive.coulomb_neg_v);
      d->qfrc_applied[at] -= newton * lugre_damping(z_slope, speed, way, newton, drive.inertia_kg);
    }
    if (physics_.drive[i].gap > 0) apply_flanks(i);
  }
}

void Crane::apply_flanks(std::size_t axis) {
  mjData* d = data_.get();
  const auto at = static_cast<std::size_t>(joints_.motor[axis]),
             far = static_cast<std::size_t>(joints_.far[axis]);
  const DriveFault& fault = physics_.drive[axis];
  const double mass =
      axis == kTrolley ? physics_.rig.trolley_mass_kg : fault.far_share * physics_.rig.drive[axis].inertia_kg;
  const double w = kTau * kFlank_hz, side = sign_of(d->qpos[far]),
               beyond = std::abs(d->qpos[far]) - fault.gap / 2;
  if (beyond > 0) {
    const double push = mass * (w * w * beyond + 2 * kFlankDamping * w * side * d->qvel[far]);
    d->qfrc_applied[far] -= side * std::max(0.0, push);
    return;
  }
  // A force on the far side acts on both coordinates, because the position of the far side is their sum.
  const double guide = mass * fault.guide_deceleration * std::tanh((d->qvel[at] + d->qvel[far]) / kGuide_mps);
  d->qfrc_applied[far] -= guide;
  d->qfrc_applied[at] -= guide;
}

void Crane::apply_load_forces(double time_s, const Disturbance& disturbance) {
  mjData* d = data_.get();
  const LoadFault& fault = physics_.load;
  mjtNum velocity[6];  // rotation, then translation
  mj_objectVelocity(model_.get(), d, mjOBJ_BODY, joints_.load_body, velocity, 0);
  const double* v = velocity + 3;
  const double speed = std::hypot(v[0], v[1], v[2]);
  const double drag = fault.linear_drag_nspm + fault.quadratic_drag_ns2pm2 * speed;
  std::array<double, 3> force{-drag * v[0], -drag * v[1], -drag * v[2]};
  const auto push = [&](double newton, double direction) {
    force[0] += newton * std::cos(direction);
    force[1] += newton * std::sin(direction);
  };
  if (disturbance.load_n) {
    const double jib = joints_.motor[kSlew] >= 0 ? d->qpos[joints_.motor[kSlew]] : 0;
    const auto [along, across] = disturbance.load_n(time_s);
    push(along, jib);
    push(across, jib + kTau / 4);
  }
  push(fault.wind_n, fault.wind_direction_rad);
  push(fault.periodic_n * std::sin(kTau * fault.periodic_hz * time_s), fault.periodic_direction_rad);
  for (const auto& [from, to, direction] : fault.pushes)
    if (time_s >= from && time_s < to)
      push(fault.push_n * std::sin(kTau / 2 * (time_s - from) / (to - from)), direction);
  std::copy(force.begin(), force.end(), d->xfrc_applied + 6 * static_cast<std::ptrdiff_t>(joints_.load_body));
  for (const int joint : joints_.swing)
    if (joint >= 0) {
      const double rate = d->qvel[joint];
      d->qfrc_applied[joint] -=
          fault.pivot_viscous_nmsprad * rate + fault.pivot_coulomb_nm * std::tanh(rate / kPivot_radps);
    }
}

double Crane::ceiling(std::size_t axis, double z, double speed) const {
  const Drive& drive = physics_.rig.drive[axis];
  const DriveFault& fault = physics_.drive[axis];
  const double level = std::max(kLeast_v, z > 0 ? drive.coulomb_pos_v : drive.coulomb_neg_v);
  return 1 + fault.stribeck_v / level * std::exp(-std::pow(speed / fault.stribeck_speed, 2));
}

}  // namespace mujoco_truth
