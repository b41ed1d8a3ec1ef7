#pragma once
/// One setting of each term.
#include <vector>

#include "crane/plant/parameters.hpp"

namespace crane::test {

/// An effect of each kind, large enough for the encoders.
inline std::vector<plant::TermSetting> every_effect() {
  return {
      {"payload_mass", "", {{"delta_kg", 0.5}}},
      {"drive_friction", "trolley", {{"coulomb_positive_v", 0.5}}},
      {"coulomb_friction", "slew", {{"level_v", 0.2}}},
      {"viscous_friction", "trolley", {{"vspm", 0.5}}},
      {"direction_asymmetry", "trolley", {{"coulomb_v", 0.1}, {"viscous_vspm", 0.3}}},
      {"stribeck_friction", "slew", {{"excess_v", 0.3}}},
      {"position_dependent_friction", "trolley", {{"amplitude_v", 0.3}, {"wavelength", 0.2}}},
      {"torque_ripple", "slew", {{"amplitude_v", 0.3}, {"period", 0.14}}},
      {"position_force", "trolley", {{"stiffness_vpm", 0.5}, {"offset_v", 0.1}}},
      {"gear_friction", "slew", {{"share", 0.3}}},
      {"motor_gain", "trolley", {{"factor", 0.9}}},
      {"command_offset", "slew", {{"offset_v", 0.1}}},
      {"command_dead_zone", "trolley", {{"width_v", 0.2}}},
      {"command_saturation", "slew", {{"limit_v", 1.5}}},
      {"command_rate_limit", "trolley", {{"rate_vps", 8}}},
      {"command_delay", "trolley", {{"delay_s", 0.033}}},
      {"actuator_lag", "slew", {{"time_constant_s", 0.05}}},
      {"load_linear_drag", "", {{"coefficient_nspm", 0.1}}},
      {"load_quadratic_drag", "", {{"coefficient_ns2pm2", 0.1}}},
      {"steady_wind", "", {{"force_n", 0.3}, {"direction_rad", 1}}},
      {"wind_gust", "", {{"coefficient_ns2pm2", 0.015}, {"mean_mps", 5}, {"scatter_mps", 1.5}}},
      {"swing_pivot_friction", "", {{"coulomb_nm", 0.02}}},
      {"jib_tilt", "", {{"angle_rad", 0.01}}},
      {"cable_length", "", {{"delta_m", 0.05}}},
      {"jib_flexibility", "", {{"compliance_s2", 0.003}}},
      {"cable_elasticity", "", {{"compliance_mpn", 0.002}}},
      {"double_pendulum", "", {{"lower_share", 0.4}, {"lower_length_m", 0.25}}},
      {"backlash", "trolley", {{"gap", 0.004}}},
      {"backlash", "slew", {{"gap", 0.01}}},
      {"swing_offset", "radial", {{"offset_rad", 0.01}}},
      {"swing_misalignment", "", {{"angle_rad", 0.1}}},
      {"swing_scale", "tangential", {{"factor", 1.1}}},
      {"position_scale", "slew", {{"factor", 1.02}}},
      {"position_drift", "trolley", {{"rate", 0.01}}},
      {"swing_delay", "radial", {{"delay_s", 0.025}}},
      {"swing_moving_average", "tangential", {{"window_s", 0.05}}},
  };
}

}  // namespace crane::test
