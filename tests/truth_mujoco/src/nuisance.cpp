#include "nuisance.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace mujoco_truth {
namespace {

constexpr double kCoarsest_rad = 0.02;  ///< coarsest swing sensor: a potentiometer with 8 bits

double rounded(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return std::strtod(text.data(), nullptr);
}

/// Draws numbers near their base values and stores their relative deviations.
class Near {
 public:
  explicit Near(Chance& chance) : chance_(chance) {}
  double operator()(double base) {
    const double change = chance_.uniform(-kGeometry, kGeometry);
    squares_ += change * change;
    ++count_;
    return rounded(base * (1 + change));
  }
  [[nodiscard]] double rms() const { return count_ == 0 ? 0 : std::sqrt(squares_ / count_); }

 private:
  Chance& chance_;
  double squares_ = 0;
  int count_ = 0;
};

Drive trolley_of(Kind kind, Near& near) {
  Drive d;
  d.there = true;
  d.inertia_kg = near(kind == Kind::tower ? 18 : 12);
  d.gain_mps2pv = near(kind == Kind::tower ? 1.8 : 1.3);
  d.viscous_pos_vspm = near(2), d.viscous_neg_vspm = near(3);
  d.coulomb_pos_v = near(0.8), d.coulomb_neg_v = near(0.9);
  const double travel = near(kind == Kind::gantry ? 3 : 1.6);
  d.low_m = kind == Kind::tower ? 0.1 : rounded(-travel / 2);
  d.high_m = rounded(d.low_m + travel);
  return d;
}

Drive slew_of(Near& near) {
  Drive d;
  d.there = true;
  d.inertia_kg = near(8);
  d.gain_mps2pv = near(1.2);
  d.viscous_pos_vspm = near(0.3), d.viscous_neg_vspm = near(0.25);
  d.coulomb_pos_v = near(0.6), d.coulomb_neg_v = near(0.6);
  d.high_m = near(3);
  d.low_m = -d.high_m;
  return d;
}

}  // namespace

const char* name_of(Controller controller) {
  return std::array{"position_pd", "friction_compensated", "open_loop",
                    "operator_jog"}[static_cast<std::size_t>(controller)];
}

double draw(const Range& range, Chance& chance) {
  const bool none = chance.happens(range.none);
  const double value = chance.log_uniform(range.low, range.high);
  return none ? 0 : value;
}

Nuisance drawn_nuisance(Chance& chance) {
  Nuisance n;
  n.disturbance_n = draw(kDisturbance, chance);
  n.drive_disturbance_v = draw(kDriveDisturbance, chance);
  n.correlation_s = draw(kCorrelation, chance);
  n.swing_rad = draw(kSwing, chance) * std::numbers::pi / 180;
  n.rate_hz = rounded(draw(kRate, chance));
  n.jitter = draw(kJitter, chance);
  n.dropped = draw(kDropped, chance);
  n.swing_resolution = draw(kResolution, chance);
  n.position_resolution = draw(kResolution, chance);
  n.noise_counts = draw(kNoise, chance);
  n.law = static_cast<StandstillLaw>(chance.below(3));
  n.presliding_m = draw(kPresliding, chance);
  n.controller = static_cast<Controller>(chance.below(4));
  n.bandwidth_radps = std::min(chance.uniform(1.5, 5), n.rate_hz / 10);
  n.anti_swing = chance.happens(0.4) ? chance.uniform(0.1, 0.5) : 0;
  n.foreign_columns = chance.happens(0.15);
  n.states_resolution = chance.happens(0.7);
  return n;
}

Rig drawn_rig(Kind kind, const Nuisance& nuisance, Chance& chance, double& geometry) {
  Near near(chance);
  Rig rig;
  rig.kind = kind;
  const bool slew_alone = kind == Kind::drive_axis && chance.happens(0.3);
  if (kind != Kind::pendulum && !slew_alone) rig.drive[kTrolley] = trolley_of(kind, near);
  if (kind == Kind::tower || slew_alone) rig.drive[kSlew] = slew_of(near);
  if (rig.drive[kTrolley].there)
    rig.trolley_mass_kg = rounded(rig.drive[kTrolley].inertia_kg * chance.uniform(0.1, 0.4));
  rig.drive[kTrolley].counts_per_m = rounded(1e5 * nuisance.position_resolution);
  rig.drive[kSlew].counts_per_m = rounded(2e4 * nuisance.position_resolution);
  if (rig.has_load()) {
    rig.load_mass_kg = near(2.5);
    rig.cable_m = near(1.1);
    rig.tangential = kind == Kind::tower || (kind == Kind::pendulum && chance.happens(0.6));
    rig.hoist = kind != Kind::pendulum && chance.happens(0.5);
    rig.swing_counts_per_rad =
        rounded(std::max({3000 * nuisance.swing_resolution, 1 / kCoarsest_rad, 4 / nuisance.swing_rad}));
  }
  geometry = near.rms();
  return rig;
}

}  // namespace mujoco_truth
