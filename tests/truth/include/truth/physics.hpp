#pragma once
/// The crane as it really is, for one case: every number of a rig and of the effects hidden in it. Shares
/// nothing with the project's libraries; the numbers of the rigs are entered here a second time.
///
/// Signs: the load hangs from the carriage at {x, 0, 0} of the jib's frame, along the direction
///   u = {-cos(theta) sin(phi), sin(theta), -cos(theta) cos(phi)},
/// so phi ("radial") is positive with the load towards the tower and theta ("tangential") with the load
/// ahead.
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace truth {

enum class RigKind { tower, gantry, drive_axis, pendulum };

/// Drives: 0 trolley (m), 1 slew (rad).
inline constexpr std::size_t kDrives = 2;

/// One motor axis. Friction F / K_m and everything electrical in volts; "per unit" is per m/s or rad/s.
struct Drive {
  bool present = false;
  double gain = 0;  ///< acceleration per volt without load [m/s2 or rad/s2 per V]

  // Friction, LuGre: bristles that give way by `presliding` before the axis slides.
  std::array<double, 2> coulomb_v{};   ///< towards +, towards -
  std::array<double, 2> viscous_vs{};  ///< V per m/s or rad/s, likewise
  double presliding = 2e-5;            ///< m or rad
  double stribeck_v = 0;               ///< excess at standstill, decays as exp(-|v| / stribeck_speed)
  double stribeck_speed = 0.03;
  double bump_v = 0;  ///< tight spots, a narrow bump at bump_at and every bump_distance from there
  double bump_distance = 1;
  double bump_at = 0;

  // From the command to the motor.
  double amplifier_gain = 1;
  double offset_v = 0;
  double dead_zone_v = 0;  ///< rounded corners, a tenth wider towards -
  double delay_s = 0;
  double lag_s = 0;     ///< sum of the time constants of two close poles
  double ripple_v = 0;  ///< cogging, with a quarter of it at twice the frequency
  double ripple_distance = 1;
  double ripple_phase_rad = 0;

  // Between motor, which carries the encoder, and carriage or jib.
  double gap = 0;         ///< m or rad, whole width
  double stiffness = 0;   ///< N/m or N m/rad of an elastic connection; 0: stiff
  double gap_margin = 0;  ///< friction of the driven side behind a gap [N, N m]

  // Encoder.
  double encoder_scale = 1;
  double slip_per_s = 0;  ///< mean drift by lost counts [m/s, rad/s]

  // Effects without a name in the library.
  double detent_v = 0;  ///< largest force of a magnetic detent, `detent_width` from its middle
  double detent_at = 0;
  double detent_width = 0.02;
  double gain_loss = 0;  ///< share of the motor's gain that heat takes, with gain_loss_s
  double gain_loss_s = 15;
  double hysteresis_v = 0;  ///< Bouc-Wen force
  double hysteresis_distance = 0.03;
  double sticking_v = 0;  ///< friction of a brake that drags now and then
  double periodic_v = 0;  ///< force at a fixed frequency
  double periodic_hz = 0.7;
  double crosstalk = 0;  ///< share of the other drive's command that gets into this one
};

struct Physics {
  RigKind kind = RigKind::tower;
  double gravity_mps2 = 9.81;
  double trolley_inertia_kg = 22.46;  ///< felt by the trolley's motor, carriage included
  double carriage_kg = 1.97;          ///< moves along the jib
  double load_kg = 2;                 ///< 0: no load, no swing
  double jib_kgm2 = 7.2;              ///< about the tower, motor included
  std::array<Drive, kDrives> drive;
  bool radial = true, tangential = true;  ///< directions of swing the rig has
  double cable_m = 1;                     ///< as the hoist's encoder says

  double cable_error_m = 0;      ///< true length minus the encoder's
  double linear_drag_nspm = 0;   ///< on the load
  double quadratic_drag = 0;     ///< N s2/m2, of the speed through the air
  double gust_mps = 0;           ///< rms of the air's speed where drag acts
  double wind_n = 0;             ///< steady force on the load, fixed to the ground
  double wind_towards_rad = 0;   ///< 0 along the jib at slew angle 0
  double gust_share = 0;         ///< rms of the wind's gusts over its mean
  double pivot_coulomb_nm = 0;   ///< joint the cable hangs from
  double pivot_viscous = 0;      ///< N m s/rad
  double tilt_rad = 0;           ///< slope of the jib, positive: tip lower than the tower's end
  double cable_stiffness_n = 0;  ///< E A of an elastic cable [N]; 0: stiff
  double hook_kg = 0;            ///< of load_kg; the rest hangs `sling_m` lower
  double sling_m = 0;            ///< of cable_m

  std::array<double, 2> swing_offset_rad{};  ///< radial, tangential
  std::array<double, 2> swing_scale{1, 1};
  double swing_misalignment_rad = 0;  ///< sensor turned about the vertical
  double swing_delay_s = 0;
  double swing_average_s = 0;  ///< mean over so long before the sample
  double load_periodic_n = 0;  ///< force along the jib on the load at load_periodic_hz; not in the library
  double load_periodic_hz = 0.7;

  double trolley_counts_pm = 0, slew_counts_prad = 0, swing_counts_prad = 0;  ///< 0: no such encoder
  std::array<double, kDrives> low{}, high{};          ///< range that references keep to
  double pace = 1;                                    ///< speed of its motions, multiple of the tower's
  std::array<double, kDrives> bandwidth_radps{6, 5};  ///< of its position loops
  double load_effects = 1;      ///< nominal amplitude of effects on load and swing sensors, likewise
  double second_cable_m = 0.7;  ///< of the run "two_lengths"
};

/// @param name tower, gantry, drive_axis, pendulum
/// @throws std::invalid_argument naming those that exist
[[nodiscard]] Physics rig(std::string_view name);

}  // namespace truth
