#include "fault.hpp"

namespace mujoco_truth {
namespace {

using To = const FaultKind::Target&;

/// Times and directions of intermittent faults.
std::vector<Stretch> stretches(To t) {
  std::vector<Stretch> all;
  for (int i = 0; i < kStretches; ++i) {
    const std::string k = std::to_string(i);
    all.push_back({t["from" + k], t["to" + k], t["direction" + k]});
  }
  return all;
}

}  // namespace

const std::vector<FaultKind>& fault_kinds() {
  static const std::vector<FaultKind> kinds{
      // name, where, in the library, both signs, trial and largest amount, first parameter, its value without
      // the fault
      {"motor_gain", Where::drive, true, true, 0.05, 0.5, "factor", 1,
       [](To t) { t.drive().gain_change = t.amount(); }},
      {"command_offset", Where::drive, true, true, 0.1, 1.5, "offset_v", 0,
       [](To t) { t.drive().offset_v = t.amount(); }},
      {"command_dead_zone", Where::drive, true, false, 0.2, 1.5, "width_v", 0,
       [](To t) { t.drive().dead_zone_v = t.amount(); }},
      {"command_delay", Where::drive, true, false, 0.02, 0.25, "delay_s", 0,
       [](To t) { t.drive().delay_s = t.amount(); }},
      {"actuator_lag", Where::drive, true, false, 0.03, 0.4, "time_constant_s", 0,
       [](To t) { t.drive().lag_s = t.amount(); }},
      {"coulomb_friction", Where::drive, true, true, 0.15, 1.5, "level_v", 0,
       [](To t) { t.drive().coulomb_v = t.amount(); }},
      {"viscous_friction", Where::drive, true, true, 0.3, 5, "vspm", 0,
       [](To t) { t.drive().viscous_vspm = t.amount(); }},
      {"direction_asymmetry", Where::drive, true, true, 0.2, 0.9, "coulomb_v", 0,
       [](To t) { t.drive().asymmetry_v = t.amount(); }},
      {"stribeck_friction", Where::drive, true, false, 0.3, 2, "excess_v", 0,
       [](To t) { t.drive().stribeck_v = t.amount(), t.drive().stribeck_speed = t["decay_speed"]; }},
      {"position_dependent_friction", Where::drive, true, false, 0.3, 3, "amplitude_v", 0,
       [](To t) {
         t.drive().tight_v = t.amount(), t.drive().tight_wavelength = t["wavelength"],
         t.drive().tight_at = t["tight_at"];
       }},
      {"torque_ripple", Where::drive, true, false, 0.2, 2, "amplitude_v", 0,
       [](To t) {
         t.drive().ripple_v = t.amount(), t.drive().ripple_period = t["period"],
         t.drive().ripple_phase = t["phase_rad"];
       }},
      {"backlash", Where::loaded_drive, true, false, 0.002, 0.03, "gap", 0,
       [](To t) {
         t.drive().gap = t.amount(), t.drive().guide_deceleration = t["guide_deceleration"],
         t.drive().far_share = t["driven_share"];
       }},
      {"payload_mass", Where::driven_load, true, true, 0.1, 0.8, "delta_kg", 0,
       [](To t) { t.load().mass_kg = t.amount(); }},
      {"load_linear_drag", Where::load, true, false, 0.01, 0.3, "coefficient_nspm", 0,
       [](To t) { t.load().linear_drag_nspm = t.amount(); }},
      {"load_quadratic_drag", Where::load, true, false, 0.02, 0.6, "coefficient_ns2pm2", 0,
       [](To t) { t.load().quadratic_drag_ns2pm2 = t.amount(); }},
      {"steady_wind", Where::driven_load, true, false, 0.01, 0.2, "force_n", 0,
       [](To t) { t.load().wind_n = t.amount(), t.load().wind_direction_rad = t["direction_rad"]; }},
      {"swing_pivot_friction", Where::load, true, false, 0.001, 0.05, "coulomb_nm", 0,
       [](To t) {
         (t["coulomb"] > 0 ? t.load().pivot_coulomb_nm : t.load().pivot_viscous_nmsprad) = t.amount();
       }},
      {"jib_tilt", Where::driven_load, true, true, 0.01, 0.15, "angle_rad", 0,
       [](To t) { t.load().tilt_rad = t.amount(); }},
      {"cable_length", Where::load, true, true, 0.01, 0.25, "delta_m", 0,
       [](To t) { t.load().cable_m = t.amount(); }},
      {"double_pendulum", Where::load, true, false, 0.2, 0.7, "lower_share", 0,
       [](To t) { t.load().lower_share = t.amount(), t.load().lower_m = t["lower_length_m"]; }},
      {"jib_flexibility", Where::tower, true, false, 0.0016, 0.025, "compliance_s2", 0,
       [](To t) {
         t.load().jib_compliance_s2 = t.amount(), t.load().jib_share = t["jib_share"],
         t.load().jib_damping = t["damping_ratio"];
       }},
      {"swing_offset", Where::swing, true, true, 0.005, 0.15, "offset_rad", 0,
       [](To t) { t.sensor().swing_offset_rad[t.swing()] = t.amount(); }},
      {"swing_misalignment", Where::tower, true, true, 0.03, 0.4, "angle_rad", 0,
       [](To t) { t.sensor().misalignment_rad = t.amount(); }},
      {"swing_scale", Where::swing, true, true, 0.03, 0.3, "factor", 1,
       [](To t) { t.sensor().swing_scale_change[t.swing()] = t.amount(); }},
      {"swing_delay", Where::driven_load, true, false, 0.02, 0.25, "delay_s", 0,
       [](To t) { t.sensor().swing_delay_s = t.amount(); }},
      {"swing_moving_average", Where::driven_load, true, false, 0.05, 0.4, "window_s", 0,
       [](To t) { t.sensor().swing_mean_s = t.amount(); }},
      {"position_scale", Where::loaded_drive, true, true, 0.03, 0.3, "factor", 1,
       [](To t) { t.sensor().position_scale_change[t.axis()] = t.amount(); }},
      {"position_drift", Where::drive, true, true, 0.004, 0.04, "rate", 0,
       [](To t) {
         t.sensor().drift_rate[t.axis()] = t.amount(), t.sensor().drift_jump[t.axis()] = t["jump"];
       }},
      {"gain_drift", Where::drive, false, false, 0.2, 0.8, "amount", 0,
       [](To t) { t.drive().gain_loss_per_minute = t.amount(); }},
      {"sticking_brake", Where::drive, false, false, 1, 4, "amount", 0,
       [](To t) { t.drive().brake_v = t.amount(), t.drive().brake_stretches = stretches(t); }},
      {"periodic_force", Where::drive, false, false, 0.1, 2, "amount", 0,
       [](To t) {
         t.drive().vibration_v = t.amount(), t.drive().vibration_hz = t["hz"],
         t.drive().vibration_phase = t["phase"];
       }},
      {"drive_crosstalk", Where::tower_drive, false, true, 0.1, 0.6, "amount", 0,
       [](To t) { t.drive().crosstalk = t.amount(); }},
      {"hose_hysteresis", Where::drive, false, false, 0.2, 2, "amount", 0,
       [](To t) { t.drive().hose_v = t.amount(), t.drive().hose_way = t["way"]; }},
      {"encoder_eccentricity", Where::drive, false, false, 0.001, 0.02, "amount", 0,
       [](To t) {
         t.sensor().eccentricity_m[t.axis()] = t.amount(),
         t.sensor().eccentricity_period[t.axis()] = t["period"];
       }},
      {"load_periodic_force", Where::load, false, false, 0.005, 0.1, "amount", 0,
       [](To t) {
         t.load().periodic_n = t.amount(), t.load().periodic_hz = t["hz"],
         t.load().periodic_direction_rad = t["direction_rad"];
       }},
      {"hand_pushes", Where::load, false, false, 0.02, 0.25, "amount", 0,
       [](To t) { t.load().push_n = t.amount(), t.load().pushes = stretches(t); }},
  };
  return kinds;
}

}  // namespace mujoco_truth
