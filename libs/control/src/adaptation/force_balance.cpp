#include "adaptation/force_balance.hpp"

#include <algorithm>
#include <cmath>

#include "crane/plant/equations.hpp"

namespace crane::control::adaptation {

ForceBalance::ForceBalance(const Design& design) : unit_load_{design.crane}, period_s_{design.period_s} {
  unit_load_.load_mass_kg = 1;
}

bool ForceBalance::step(const Measurement& measured) noexcept {
  constexpr int kNeeded = 2;  // earlier ticks
  const bool complete = ticks_ >= kNeeded;
  if (complete) evaluate(measured);
  before_[1] = before_[0];
  before_[0] = measured;
  ticks_ = std::min(ticks_ + 1, kNeeded);
  return complete;
}

void ForceBalance::evaluate(const Measurement& now) noexcept {
  const Measurement &middle = before_[0], &first = before_[1];
  const auto rate = [&](double last, double earliest) { return (last - earliest) / (2 * period_s_); };
  const auto second = [&](std::size_t i) {
    return (now.position[i] - 2 * middle.position[i] + first.position[i]) / (period_s_ * period_s_);
  };
  plant::State s;
  s.trolley_m = middle.position[kTrolley];
  s.slew_rad = middle.position[kSlew];
  s.cable_m = middle.position[kHoist];
  s.radial_rad = middle.swing_radial_rad;
  s.tangential_rad = middle.swing_tangential_rad;
  s.trolley_mps = rate(now.position[kTrolley], first.position[kTrolley]);
  s.slew_radps = rate(now.position[kSlew], first.position[kSlew]);
  s.radial_radps = rate(now.swing_radial_rad, first.swing_radial_rad);
  s.tangential_radps = rate(now.swing_tangential_rad, first.swing_tangential_rad);
  plant::Accelerations q;
  q.trolley_mps2 = second(kTrolley);
  q.slew_radps2 = second(kSlew);
  const double tension_npkg = plant::cable_tension(unit_load_, s).tension_n(q);
  const double ex = -std::cos(s.tangential_rad) * std::sin(s.radial_rad), ey = std::sin(s.tangential_rad);
  const auto& p = unit_load_;
  const double x = s.trolley_m, moving = p.trolley_mass_kg;
  const auto volts = [&](std::size_t i) { return (middle.applied_v[i] + first.applied_v[i]) / 2; };
  const double trolley_npv = p.trolley_inertia_kg * p.trolley_gain_mps2pv;
  const double slew_nmpv = p.jib_inertia_kgm2 * p.slew_gain_radps2pv;
  const double centrifugal_n = moving * x * s.slew_radps * s.slew_radps;
  const double turning_nm = -moving * x * x * q.slew_radps2 - 2 * moving * x * s.trolley_mps * s.slew_radps;
  balance_[kTrolley] = {
      .free_v = volts(kTrolley) - q.trolley_mps2 / p.trolley_gain_mps2pv + centrifugal_n / trolley_npv,
      .load_vpkg = tension_npkg * ex / trolley_npv,
      .inertia_v = q.trolley_mps2 / p.trolley_gain_mps2pv,
      .speed = s.trolley_mps};
  balance_[kSlew] = {
      .free_v = volts(kSlew) - q.slew_radps2 / p.slew_gain_radps2pv + turning_nm / slew_nmpv,
      .load_vpkg = x * tension_npkg * ey / slew_nmpv,
      .inertia_v = q.slew_radps2 * (1 + p.trolley_to_jib_ratio() * x * x) / p.slew_gain_radps2pv,
      .speed = s.slew_radps};
}

}  // namespace crane::control::adaptation
