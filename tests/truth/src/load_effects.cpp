#include "effect_forms.hpp"

#include <algorithm>

namespace truth {

void payload_mass(const Making& m) {
  const double kg = std::max(0.2, m.crane.load_kg * (1 + 0.4 * m.size));
  m.say("mass_change_kg", kg - m.crane.load_kg, "kg");
  m.crane.load_kg = m.say("load_mass_kg", kg, "kg");
}

void cable_length(const Making& m) { m.crane.cable_error_m = m.say("length_change_m", 0.05 * m.size, "m"); }

void load_linear_drag(const Making& m) {
  m.crane.linear_drag_nspm = m.say("coefficient_nspm", 0.3 * m.size, "N s/m");
  m.crane.gust_mps = 0.05;
}

void load_quadratic_drag(const Making& m) {
  m.crane.quadratic_drag = m.say("coefficient_ns2pm2", 0.7 * m.size, "N s2/m2");
  m.crane.gust_mps = 0.05;
}

void steady_wind(const Making& m) {
  m.crane.wind_n = m.say("force_n", 0.5 * m.size, "N");
  m.crane.wind_towards_rad = m.say("direction_rad", m.random.uniform(-3.1, 3.1), "rad");
  m.crane.gust_share = 0.03;
  m.crane.gust_mps = std::max(m.crane.gust_mps, 0.02);
}

void swing_pivot_friction(const Making& m) {
  m.crane.pivot_coulomb_nm = m.say("coulomb_nm", 0.05 * m.size, "N m");
  m.crane.pivot_viscous = m.say("viscous_nmsprad", 0.08 * m.size, "N m s/rad");
}

void jib_tilt(const Making& m) { m.crane.tilt_rad = m.say("tilt_rad", 0.02 * m.size, "rad"); }

void jib_flexibility(const Making& m) {
  m.crane.drive[1].stiffness = m.say("stiffness_nmprad", 800 / m.size, "N m/rad");
}

void cable_elasticity(const Making& m) {
  m.crane.cable_stiffness_n = 250 / m.size;
  m.say("stiffness_npm", m.crane.cable_stiffness_n / m.crane.cable_m, "N/m");
}

void double_pendulum(const Making& m) {
  m.crane.hook_kg = m.say("hook_mass_kg", 0.3 * m.crane.load_kg, "kg");
  m.crane.sling_m = m.say("sling_m", std::min(0.12 * m.size, 0.3) * m.crane.cable_m, "m");
}

void swing_offset(const Making& m) {
  m.crane.swing_offset_rad[m.axis] = m.say("offset_rad", 0.015 * m.size, "rad");
}

void swing_misalignment(const Making& m) {
  m.crane.swing_misalignment_rad = m.say("angle_rad", 0.1 * m.size, "rad");
}

void swing_scale(const Making& m) { m.crane.swing_scale[m.axis] = m.say("factor", 1 + 0.08 * m.size, "1"); }

void swing_delay(const Making& m) { m.crane.swing_delay_s = m.say("delay_s", 0.04 * m.size, "s"); }

void swing_moving_average(const Making& m) {
  m.crane.swing_average_s = m.say("window_s", 0.12 * m.size, "s");
}

void load_periodic_force(const Making& m) {
  m.crane.load_periodic_n = m.say("amplitude_n", 0.5 * m.size, "N");
  m.crane.load_periodic_hz = m.say("frequency_hz", m.random.uniform(0.65, 1.2), "Hz");
}

}  // namespace truth
