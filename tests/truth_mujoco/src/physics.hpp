#pragma once
/// Parameters of one simulated crane: those of the rig file, and their errors.
#include <array>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace mujoco_truth {

enum class Kind { tower, gantry, drive_axis, pendulum };
[[nodiscard]] const char* name_of(Kind kind);

enum Axis : std::size_t { kTrolley = 0, kSlew = 1, kAxes = 2 };
inline constexpr std::array kAxisNames{"trolley", "slew"};
enum Swing : std::size_t { kRadial = 0, kTangential = 1, kSwings = 2 };

inline constexpr std::array kSwingNames{"radial", "tangential"};
inline constexpr double kTau = 2 * std::numbers::pi;

/// One motor and the mass that it moves. Units of the trolley; the slew drive has rad for m and kg m2 for kg.
struct Drive {
  bool there = false;
  double inertia_kg = 0;   ///< M, or J_o of the jib
  double gain_mps2pv = 0;  ///< K_m
  double viscous_pos_vspm = 0, viscous_neg_vspm = 0;
  double coulomb_pos_v = 0, coulomb_neg_v = 0;
  double low_m = 0, high_m = 0;
  double counts_per_m = 0;
};

/// All values of the rig file of a set, exactly as in the file.
struct Rig {
  Kind kind = Kind::tower;
  std::array<Drive, kAxes> drive;
  bool hoist = false, tangential = false;
  double gravity_mps2 = 9.81, trolley_mass_kg = 0, load_mass_kg = 0, cable_m = 1;
  double swing_counts_per_rad = 0;
  [[nodiscard]] bool has_load() const { return kind != Kind::drive_axis; }
  [[nodiscard]] bool has_swing(std::size_t i) const { return has_load() && (i == kRadial || tangential); }
};

/// Law of the friction before the axis slides. With all three laws, the axis slides at the levels of the rig
/// file.
enum class StandstillLaw { dahl, lugre, elasto_plastic };
[[nodiscard]] const char* name_of(StandstillLaw law);

/// Interval of time in which an intermittent fault acts.
struct Stretch {
  double from_s = 0, to_s = 0, direction_rad = 0;
};

/// Faults of a drive; all zero: no fault. The volts are those of the amplifier.
struct DriveFault {
  double gain_change = 0, offset_v = 0, dead_zone_v = 0, delay_s = 0, lag_s = 0;
  double coulomb_v = 0, viscous_vspm = 0, asymmetry_v = 0;
  double stribeck_v = 0, stribeck_speed = 0.05;
  double tight_v = 0, tight_wavelength = 1, tight_at = 0;
  double ripple_v = 0, ripple_period = 0.1, ripple_phase = 0;
  double gap = 0, guide_deceleration = 0.5, far_share = 0.3;
  // Faults outside the library of `crane diagnose`.
  double gain_loss_per_minute = 0;
  double brake_v = 0;  ///< friction of a brake that drags in `brake_stretches`
  std::vector<Stretch> brake_stretches;
  double vibration_v = 0, vibration_hz = 1, vibration_phase = 0;
  double crosstalk = 0;  ///< share of the other drive's command
  double hose_v = 0, hose_way = 0.2;
};

struct LoadFault {
  double mass_kg = 0, linear_drag_nspm = 0, quadratic_drag_ns2pm2 = 0;
  double wind_n = 0, wind_direction_rad = 0;
  double pivot_viscous_nmsprad = 0, pivot_coulomb_nm = 0;
  double tilt_rad = 0;  ///< positive: the tip of the jib, the far end of the track, is raised
  double cable_m = 0;   ///< true minus stated length
  double lower_share = 0, lower_m = 0.3;                              ///< double pendulum
  double jib_compliance_s2 = 0, jib_damping = 0.02, jib_share = 0.5;  ///< flexible jib
  double periodic_n = 0, periodic_hz = 0.5, periodic_direction_rad = 0;
  double push_n = 0;
  std::vector<Stretch> pushes;
};

struct SensorFault {
  std::array<double, kSwings> swing_offset_rad{}, swing_scale_change{};
  double misalignment_rad = 0, swing_delay_s = 0, swing_mean_s = 0;
  std::array<double, kAxes> position_scale_change{}, drift_rate{}, drift_jump{};
  std::array<double, kAxes> eccentricity_m{}, eccentricity_period{0.2, 0.2};
};

struct Physics {
  Rig rig;
  StandstillLaw law = StandstillLaw::dahl;
  double presliding_m = 2e-5;  ///< distance over which dry friction develops
  std::array<DriveFault, kAxes> drive;
  LoadFault load;
  SensorFault sensor;
};

}  // namespace mujoco_truth
