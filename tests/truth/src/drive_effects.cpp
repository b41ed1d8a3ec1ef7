#include "effect_forms.hpp"

#include <algorithm>
#include <numbers>

namespace truth {
namespace {

std::string per(const Making& m, const std::string& unit) {
  return m.axis == 0 ? unit + "/m" : unit + "/rad";
}
std::string length(const Making& m) { return m.axis == 0 ? "m" : "rad"; }

}  // namespace

void coulomb_friction(const Making& m) {
  auto& levels = m.drive().coulomb_v;
  const std::array<double, 2> nominal{0.3, 0.22};
  const double least = 0.02 - std::min(levels[0], levels[1]);  // smallest remaining friction
  const double more = m.say("coulomb_v", std::max(least, m.size * nominal[m.axis]), "V");
  for (double& level : levels) level += more;
}

void viscous_friction(const Making& m) {
  auto& slopes = m.drive().viscous_vs;
  const std::array<double, 2> nominal{1.0, 0.7};
  const double least = -std::min(slopes[0], slopes[1]);
  const double more = m.say("viscous_vspm", std::max(least, m.size * nominal[m.axis]), per(m, "V s"));
  for (double& slope : slopes) slope += more;
}

void direction_asymmetry(const Making& m) {
  Drive& d = m.drive();
  const std::array<double, 2> level_v{0.5, 0.4}, slope_vs{0.8, 0.15};
  const auto change = [&](const std::string& name, std::array<double, 2>& values, double difference,
                          double least, const std::string& unit) {
    m.say(name, difference, unit);
    values = {values[0] + difference / 2, values[1] - difference / 2};
    const double lift = std::max(0.0, least - std::min(values[0], values[1]));
    for (double& value : values) value += lift;
  };
  change("coulomb_difference_v", d.coulomb_v, m.size * level_v[m.axis], 0.02, "V");
  change("viscous_difference_vspm", d.viscous_vs, m.size * slope_vs[m.axis], 0, per(m, "V s"));
}

void stribeck_friction(const Making& m) {
  m.drive().stribeck_v = m.scaled("excess_v", {0.8, 0.6}, "V");
  m.drive().stribeck_speed = m.say("decay_speed", m.axis == 0 ? 0.04 : 0.06, length(m) + "/s");
}

void position_dependent_friction(const Making& m) {
  Drive& d = m.drive();
  d.bump_v = m.scaled("amplitude_v", {0.7, 0.5}, "V");
  d.bump_distance = m.say("wavelength", m.random.uniform(0.28, 0.45) * (m.axis == 0 ? 1 : 2.2), length(m));
  d.bump_at = m.say("tight_at", m.crane.low[m.axis] + m.random.uniform(0, d.bump_distance), length(m));
}

void motor_gain(const Making& m) { m.drive().amplifier_gain = m.say("factor", 1 + 0.12 * m.size, "1"); }

void command_offset(const Making& m) { m.drive().offset_v = m.scaled("offset_v", {0.2, 0.15}, "V"); }

void command_dead_zone(const Making& m) { m.drive().dead_zone_v = m.scaled("width_v", {0.35, 0.3}, "V"); }

void command_delay(const Making& m) { m.drive().delay_s = m.scaled("delay_s", {0.035, 0.035}, "s"); }

void actuator_lag(const Making& m) { m.drive().lag_s = m.scaled("lag_s", {0.06, 0.06}, "s"); }

void torque_ripple(const Making& m) {
  Drive& d = m.drive();
  d.ripple_v = m.scaled("amplitude_v", {0.6, 0.4}, "V");
  d.ripple_distance = m.say("wavelength", m.axis == 0 ? 0.0127 : 2 * std::numbers::pi / 45, length(m));
  d.ripple_phase_rad = m.say("phase_rad", m.random.uniform(-3.1, 3.1), "rad");
}

void backlash(const Making& m) {
  m.drive().gap = m.scaled("gap", {0.006, 0.012}, length(m));
  m.drive().gap_margin = m.axis == 0 ? 1.5 : 0.3;
}

void position_scale(const Making& m) { m.drive().encoder_scale = m.say("factor", 1 + 0.05 * m.size, "1"); }

void position_drift(const Making& m) {
  m.drive().slip_per_s = m.scaled("drift_ps", {0.0015, 0.003}, length(m) + "/s");
}

void magnetic_detent(const Making& m) {
  Drive& d = m.drive();
  d.detent_v = m.scaled("force_v", {1.5, 1.0}, "V");
  const double low = m.crane.low[m.axis], high = m.crane.high[m.axis];
  d.detent_at = m.say("at", low + m.random.uniform(0.4, 0.6) * (high - low), length(m));
  d.detent_width = m.axis == 0 ? 0.03 : 0.06;
}

void gain_drift(const Making& m) {
  m.drive().gain_loss = m.say("final_loss", std::min(0.9, 0.35 * m.size), "1");
}

void hysteretic_force(const Making& m) {
  m.drive().hysteresis_v = m.scaled("force_v", {0.9, 0.6}, "V");
  m.drive().hysteresis_distance = m.axis == 0 ? 0.05 : 0.12;
}

void sticking_brake(const Making& m) { m.drive().sticking_v = m.scaled("friction_v", {1.0, 0.7}, "V"); }

void periodic_force(const Making& m) {
  m.drive().periodic_v = m.scaled("amplitude_v", {0.4, 0.3}, "V");
  m.drive().periodic_hz = m.say("frequency_hz", m.random.uniform(0.6, 1.3), "Hz");
}

void crosstalk(const Making& m) { m.drive().crosstalk = m.say("share", 0.25 * m.size, "1"); }

}  // namespace truth
