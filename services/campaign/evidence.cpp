#include "campaign/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace crane::campaign {

double Evidence::gain() const {
  const auto& p = bench_->setting().configured.plant;
  if (axis_ == 0) return p.trolley_gain_mps2pv;
  if (axis_ == 2) return p.hoist_gain_mpspv / p.hoist_lag_s;
  const double x = bench_->now().truth.position[0];
  return p.slew_gain_radps2pv * p.jib_inertia_kgm2 / (p.jib_inertia_kgm2 + p.trolley_mass_kg * x * x);
}

double Evidence::tolerance_v(double applied_v, double speed) const {
  constexpr double kGain = 0.25, kOffset_v = 0.3, kMost = 1.5, kExtra_v = 0.3;
  const auto& rig = bench_->setting().configured;
  const auto& friction = rig.design.friction[axis_];
  const double rest_v = std::max({friction.coulomb_positive_v, friction.coulomb_negative_v,
                                  friction.stiction_positive_v, friction.stiction_negative_v});
  const double viscous_vs_per_unit = std::max(friction.viscous_positive_vspm, friction.viscous_negative_vspm);
  const auto& truth = bench_->now().truth;
  double load_v = 0;
  const double weight_n = kMost * rig.plant.load_mass_kg * rig.plant.gravity_mps2;
  if (axis_ == 0)
    load_v = weight_n * std::sin(std::abs(truth.swing_radial_rad)) / rig.plant.trolley_inertia_kg / gain();
  if (axis_ == 1)
    load_v = weight_n * std::sin(std::abs(truth.swing_tangential_rad)) * truth.position[0] /
             rig.plant.jib_inertia_kgm2 / gain();
  if (axis_ == 2) load_v = kGain * std::abs(speed) / rig.plant.hoist_gain_mpspv;
  return kGain * std::abs(applied_v) + kOffset_v + kMost * (rest_v + viscous_vs_per_unit * std::abs(speed)) +
         kExtra_v + load_v;
}

double Evidence::visible_speed(double speed) const {
  constexpr double kShare = 0.1, kCounts = 4;
  const auto& rig = bench_->setting().configured;
  return kShare * (rig.drives[axis_].max_speed + std::abs(speed)) +
         kCounts / (rig.encoders[axis_].counts_per_unit * rig.period_s);
}

bool Evidence::of_drive() {
  const auto& truth = bench_->now().truth;
  const double v = truth.speed[axis_];
  const double error_v = std::abs(bench_->rig().output_error_v(axis_));
  const double excess_v = error_v - tolerance_v(truth.written_v[axis_], v);
  const double dt_s = bench_->setting().configured.period_s;
  sum_above_ = truth.brake_closed[axis_] ? 0 : std::max(0.0, sum_above_ + gain() * excess_v * dt_s);
  visible_ = visible_ || sum_above_ > visible_speed(v);
  return visible_;
}

bool Evidence::of_standing_encoder() {
  const auto& truth = bench_->now().truth;
  const double dt_s = bench_->setting().configured.period_s;
  if (!started_) {
    sum_above_ = std::max(truth.speed[axis_], 0.0);
    sum_below_ = std::max(-truth.speed[axis_], 0.0);
    started_ = true;
  } else {
    const double u = truth.written_v[axis_], unknown_v = tolerance_v(u, 0);
    sum_above_ = std::max(0.0, sum_above_ + gain() * (u - unknown_v) * dt_s);
    sum_below_ = std::max(0.0, sum_below_ + gain() * (-u - unknown_v) * dt_s);
  }
  if (truth.brake_closed[axis_]) sum_above_ = sum_below_ = 0;
  visible_ = visible_ || std::max(sum_above_, sum_below_) > visible_speed(0);
  return visible_;
}

SwingEvidence::SwingEvidence(Bench& bench, std::size_t counter)
    : bench_{&bench},
      radial_{counter == 3},
      at_first_rad_{radial_ ? bench.now().truth.swing_radial_rad : bench.now().truth.swing_tangential_rad},
      before_{bench.now().truth} {}

SwingEvidence::Positions SwingEvidence::positions_of(const Truth& truth, double shown_rad) const {
  const double radial = radial_ ? shown_rad : truth.swing_radial_rad;
  const double tangential = radial_ ? truth.swing_tangential_rad : shown_rad;
  const double cable_m = truth.position[2];
  const std::complex<double> jib = std::polar(1.0, truth.position[1]);
  return {
      .trolley_m = truth.position[0] * jib,
      .load_m = cable_m * jib * std::complex{-std::cos(tangential) * std::sin(radial), std::sin(tangential)},
      .depth_m = cable_m * std::cos(tangential) * std::cos(radial)};
}

bool SwingEvidence::of_standing_encoder(double shown_rad) {
  constexpr double kZero_rad = 0.02, kWind_mps2 = 0.25, kSpeed_mps = 0.05, kMean = 4, kCable = 0.55;
  const auto& rig = bench_->setting().configured;
  const auto& truth = bench_->now().truth;
  const double g = rig.plant.gravity_mps2, dt_s = rig.period_s;
  if (older_) {
    const Positions a = positions_of(*older_, shown_rad), b = positions_of(before_, shown_rad),
                    c = positions_of(truth, shown_rad);
    const auto swung = (c.load_m - 2.0 * b.load_m + a.load_m) / dt_s;
    const auto carried = (c.trolley_m - 2.0 * b.trolley_m + a.trolley_m) / dt_s;
    const double sinking_mps2 = (c.depth_m - 2 * b.depth_m + a.depth_m) / (dt_s * dt_s);
    const auto imbalance = swung + carried + (g - sinking_mps2) / b.depth_m * dt_s * b.load_m;
    // Component in the direction of the encoder: along or across the jib.
    const auto to_encoder =
        std::polar(1.0, -before_.position[1]) * (radial_ ? std::complex{1.0} : std::complex{0.0, -1.0});
    const double seen = (imbalance * to_encoder).real();
    const double tolerance =
        (g * kZero_rad + kWind_mps2) * dt_s + kCable * std::abs((swung * to_encoder).real());
    up_ = std::max(0.0, up_ + seen - tolerance);
    down_ = std::max(0.0, down_ - seen - tolerance);
  }
  older_ = std::exchange(before_, truth);
  const double noise_mps = 2 * 1.5 * truth.position[2] / rig.encoders[3].counts_per_unit / (kMean * dt_s);
  visible_ = visible_ || std::max(up_, down_) > 2 * (kSpeed_mps + noise_mps);
  return visible_;
}

}  // namespace crane::campaign
