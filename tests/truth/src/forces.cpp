/// Forces on the crane: drives, friction, connections, wind.
#include <algorithm>
#include <cmath>

#include "crane.hpp"

namespace truth {
namespace {

constexpr std::array<double, kDrives> kContactStiffness{1e5, 4e4};  // N/m, N m/rad
constexpr double kContactDamping = 0.15, kElasticDamping = 0.03;    // damping ratio

double sign(double value) { return value < 0 ? -1 : 1; }

/// The output is 0 below the threshold (the mean of both sides), above it the input minus the threshold; the
/// corners are rounded.
double dead_zone(double volts, double threshold_v) {
  const double width = (volts < 0 ? 1.05 : 0.95) * threshold_v;
  if (width <= 0) return volts;
  const double beyond = std::abs(volts) - width, corner = 0.1 * width;
  return sign(volts) * corner * std::log1p(std::exp(std::min(beyond / corner, 600.0)));
}

}  // namespace

double Crane::amplifier(std::size_t axis, const Volts& command_v, double time_s) const {
  const Drive& d = physics_.drive[axis];
  const double heat = d.gain_loss * (1 - std::exp(-time_s / d.gain_loss_s));
  const double input_v = command_v[axis] + d.crosstalk * command_v[1 - axis];
  return d.amplifier_gain * (1 - heat) * dead_zone(input_v, d.dead_zone_v) + d.offset_v;
}

double Crane::friction_level(std::size_t axis, double position, double speed, double time_s) const {
  const Drive& d = physics_.drive[axis];
  double level = d.coulomb_v[speed < 0 ? 1 : 0];
  if (d.stribeck_v > 0) level += d.stribeck_v * std::exp(-std::abs(speed) / d.stribeck_speed);
  if (d.bump_v > 0) {
    const double turn = 2 * std::numbers::pi * (position - d.bump_at) / d.bump_distance;
    level += d.bump_v * std::exp(1.5 * (std::cos(turn) - 1));
  }
  if (d.sticking_v > 0)
    for (const Span& span : dragging_)
      if (time_s >= span.from_s && time_s < span.to_s) level += d.sticking_v;
  return level;
}

/// Input of the drive minus friction and all other forces on the motor [V].
double Crane::drive_v(std::size_t axis, const Moving& at, double input_v, double time_s) const {
  const Drive& d = physics_.drive[axis];
  const std::size_t c = axis == 0 ? kMotorX : kMotorSlew;
  const double position = at.q[c], speed = at.rate[c];
  double v = d.lag_s > 0 ? at.lag_2[axis] : input_v;
  v -= drive_bristles_[axis].force(speed, friction_level(axis, position, speed, time_s));
  v -= d.viscous_vs[speed < 0 ? 1 : 0] * speed;
  v += along(within_tick(time_s), before_[axis], after_[axis]);
  if (d.ripple_v != 0) {
    const double turn = 2 * std::numbers::pi * position / d.ripple_distance + d.ripple_phase_rad;
    v += d.ripple_v * (std::sin(turn) + 0.25 * std::sin(2 * turn + 1));
  }
  if (d.detent_v != 0) {
    const double s = (position - d.detent_at) / d.detent_width;
    v -= d.detent_v * s * std::exp(0.5 * (1 - s * s));
  }
  if (d.hysteresis_v != 0) v -= d.hysteresis_v * at.hysteresis[axis];
  if (d.periodic_v != 0) v += d.periodic_v * std::sin(2 * std::numbers::pi * d.periodic_hz * time_s);
  return v;
}

/// Force from motor to carriage or jib through an elastic connection or a gap; a contact only pushes.
double Crane::connection(std::size_t axis, double apart, double parting) const {
  const Drive& d = physics_.drive[axis];
  const double driven = axis == 0 ? physics_.carriage_kg : 0.65 * physics_.jib_kgm2;
  const double stiffness = d.stiffness > 0 ? d.stiffness : kContactStiffness[axis];
  const double share = d.stiffness > 0 ? kElasticDamping : kContactDamping;
  const double damping = 2 * share * std::sqrt(stiffness * driven);
  if (d.gap <= 0) return stiffness * apart + damping * parting;
  if (apart > 0.5 * d.gap) return std::max(0.0, stiffness * (apart - 0.5 * d.gap) + damping * parting);
  if (apart < -0.5 * d.gap) return std::min(0.0, stiffness * (apart + 0.5 * d.gap) + damping * parting);
  return 0;
}

void Crane::add_connections(const Moving& at, Acting& acting) const {
  constexpr std::array<std::size_t, kDrives> kMotor{kMotorX, kMotorSlew}, kDriven{kCarriage, kJib};
  for (std::size_t i = 0; i < kDrives; ++i) {
    const std::size_t motor = kMotor[i], driven = kDriven[i];
    if (!mechanics_.moves(static_cast<Coordinate>(driven))) continue;
    const double force = connection(i, at.q[motor] - at.q[driven], at.rate[motor] - at.rate[driven]);
    acting.generalised[motor] -= force;
    acting.generalised[driven] += force;
    acting.generalised[driven] -= driven_bristles_[i].force(at.rate[driven], physics_.drive[i].gap_margin);
  }
}

/// Wind, gusts and drag on the load, in the jib's frame.
Vector Crane::load_force(const Moving& at, double time_s) const {
  const double share = within_tick(time_s), slew = at.q[mechanics_.of(kJib)];
  std::array<double, 6> noise;
  for (std::size_t i = 2; i < noise.size(); ++i) noise[i] = along(share, before_[i], after_[i]);
  const double gust = physics_.gust_mps > 0 ? noise[4] / physics_.gust_mps * physics_.gust_share : 0;
  const double wind = physics_.wind_n * (1 + gust);
  const double east = wind * std::cos(physics_.wind_towards_rad) + noise[2];
  const double north = wind * std::sin(physics_.wind_towards_rad) + noise[3];
  const double c = std::cos(slew), s = std::sin(slew);
  Vector force{c * east + s * north, -s * east + c * north, 0};
  if (physics_.load_periodic_n != 0)
    force[0] +=
        physics_.load_periodic_n * std::sin(2 * std::numbers::pi * physics_.load_periodic_hz * time_s);
  if (physics_.linear_drag_nspm == 0 && physics_.quadratic_drag == 0) return force;
  const Vector v = mechanics_.load(at.q, at.rate).velocity_mps;
  const Vector air{c * noise[4] + s * noise[5], -s * noise[4] + c * noise[5], 0};
  const Vector through{v[0] - air[0], v[1] - air[1], v[2] - air[2]};
  const double speed = std::hypot(through[0], through[1], through[2]);
  for (std::size_t i = 0; i < 3; ++i)
    force[i] -= (physics_.linear_drag_nspm + physics_.quadratic_drag * speed) * through[i];
  return force;
}

Crane::Moving Crane::slope(const Moving& at, const Volts& input_v, double time_s) const {
  Moving s;
  Acting acting;
  const std::array<double, kDrives> inertia{physics_.trolley_inertia_kg, physics_.jib_kgm2};
  for (std::size_t i = 0; i < kDrives; ++i) {
    const Drive& d = physics_.drive[i];
    if (!d.present) continue;
    const std::size_t c = i == 0 ? kMotorX : kMotorSlew;
    acting.generalised[c] = inertia[i] * d.gain * drive_v(i, at, input_v[i], time_s);
    if (d.lag_s > 0) {
      s.lag_1[i] = (input_v[i] - at.lag_1[i]) / (0.55 * d.lag_s);
      s.lag_2[i] = (at.lag_1[i] - at.lag_2[i]) / (0.45 * d.lag_s);
    }
    if (d.hysteresis_v != 0) {  // Bouc-Wen with n = 2, beta = gamma = 1/2
      const double h = at.hysteresis[i], v = at.rate[c];
      s.hysteresis[i] = v / d.hysteresis_distance * (1 - h * h * 0.5 * (1 + sign(v * h)));
    }
  }
  add_connections(at, acting);
  if (physics_.load_kg > 0) {
    acting.load_n = load_force(at, time_s);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t c = i == 0 ? kRadial : kTangential;
      acting.generalised[c] -= pivot_bristles_[i].force(at.rate[c], physics_.pivot_coulomb_nm) +
                               physics_.pivot_viscous * at.rate[c];
    }
  }
  if (mechanics_.moves(kCable)) {
    const double natural = physics_.cable_m + physics_.cable_error_m;
    const double damping =
        2 * kElasticDamping * std::sqrt(physics_.cable_stiffness_n / natural * physics_.load_kg);
    const double tension =
        physics_.cable_stiffness_n * (at.q[kCable] / natural - 1) + damping * at.rate[kCable];
    acting.generalised[kCable] -= std::max(0.0, tension);
  }
  s.q = at.rate;
  s.rate = mechanics_.accelerations(at.q, at.rate, acting);
  return s;
}

}  // namespace truth
