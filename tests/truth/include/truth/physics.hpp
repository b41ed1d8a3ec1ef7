#pragma once
/// Parameters of the true crane of one case: all numbers of a rig and of its hidden effects. This code shares
/// nothing with the libraries of the project; it states the numbers of the rigs a second time.
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

/// One motor axis. Friction F / K_m and all electrical quantities are in volts; "per unit" is per m/s or
/// rad/s.
struct Drive {
  bool present = false;
  double gain = 0;  ///< acceleration per volt without load [m/s2 or rad/s2 per V]

  // LuGre friction: the bristles deflect by `presliding` before the axis slides.
  std::array<double, 2> coulomb_v{};   ///< positive, negative direction
  std::array<double, 2> viscous_vs{};  ///< V per m/s or rad/s, positive, negative direction
  double presliding = 2e-5;            ///< m or rad
  double stribeck_v = 0;               ///< excess at standstill, decays as exp(-|v| / stribeck_speed)
  double stribeck_speed = 0.03;
  double bump_v = 0;  ///< tight spots: a narrow bump at bump_at, repeated every bump_distance
  double bump_distance = 1;
  double bump_at = 0;

  // Effects between the command and the motor.
  double amplifier_gain = 1;
  double offset_v = 0;
  double dead_zone_v = 0;  ///< rounded corners; a tenth wider in negative direction
  double delay_s = 0;
  double lag_s = 0;     ///< sum of the time constants of two close poles
  double ripple_v = 0;  ///< cogging, with a quarter of it at twice the frequency
  double ripple_distance = 1;
  double ripple_phase_rad = 0;

  // Connection between the motor, which carries the encoder, and carriage or jib.
  double gap = 0;         ///< width of the gap, m or rad
  double stiffness = 0;   ///< N/m or N m/rad of an elastic connection; 0: stiff
  double gap_margin = 0;  ///< friction of the driven side behind a gap [N, N m]

  // Encoder.
  double encoder_scale = 1;
  double slip_per_s = 0;  ///< mean drift by lost counts [m/s, rad/s]

  // Effects that the library does not contain.
  /// largest force of a magnetic detent, at the distance `detent_width` from its middle
  double detent_v = 0;
  double detent_at = 0;
  double detent_width = 0.02;
  /// share of the motor gain that is lost by heating, with the time constant gain_loss_s
  double gain_loss = 0;
  double gain_loss_s = 15;
  double hysteresis_v = 0;  ///< Bouc-Wen force
  double hysteresis_distance = 0.03;
  double sticking_v = 0;  ///< friction of a brake that drags intermittently
  double periodic_v = 0;  ///< force at a fixed frequency
  double periodic_hz = 0.7;
  double crosstalk = 0;  ///< share of the other drive's command that is added to this command
};

struct Physics {
  RigKind kind = RigKind::tower;
  double gravity_mps2 = 9.81;
  double trolley_inertia_kg = 22.46;  ///< inertia that the trolley motor accelerates, including the carriage
  double carriage_kg = 1.97;          ///< mass that moves along the jib
  double load_kg = 2;                 ///< 0: no load, no swing
  double jib_kgm2 = 7.2;              ///< inertia about the tower axis, including the motor
  std::array<Drive, kDrives> drive;
  bool radial = true, tangential = true;  ///< directions of swing that the rig has
  double cable_m = 1;                     ///< cable length according to the hoist encoder

  double cable_error_m = 0;      ///< true cable length minus that of the encoder
  double linear_drag_nspm = 0;   ///< viscous drag of the load
  double quadratic_drag = 0;     ///< N s2/m2, drag of the load relative to the air
  double gust_mps = 0;           ///< rms of the wind speed for the drag
  double wind_n = 0;             ///< steady force on the load, fixed to the ground
  double wind_towards_rad = 0;   ///< 0 along the jib at slew angle 0
  double gust_share = 0;         ///< rms of the gusts / mean wind force
  double pivot_coulomb_nm = 0;   ///< Coulomb friction of the upper cable joint
  double pivot_viscous = 0;      ///< N m s/rad
  double tilt_rad = 0;           ///< inclination of the jib, positive: the tip is lower than the tower end
  double cable_stiffness_n = 0;  ///< E A of an elastic cable [N]; 0: stiff
  double hook_kg = 0;            ///< share of load_kg in the hook; the rest of the mass hangs `sling_m` lower
  double sling_m = 0;            ///< of cable_m

  std::array<double, 2> swing_offset_rad{};  ///< radial, tangential
  std::array<double, 2> swing_scale{1, 1};
  double swing_misalignment_rad = 0;  ///< rotation of the sensor about the vertical axis
  double swing_delay_s = 0;
  double swing_average_s = 0;  ///< duration of the mean before the sample
  double load_periodic_n = 0;  ///< force along the jib on the load at load_periodic_hz; not in the library
  double load_periodic_hz = 0.7;

  double trolley_counts_pm = 0, slew_counts_prad = 0, swing_counts_prad = 0;  ///< 0: no such encoder
  std::array<double, kDrives> low{}, high{};                                  ///< range of the references
  double pace = 1;                                    ///< speed of the motions / speed of those of the tower
  std::array<double, kDrives> bandwidth_radps{6, 5};  ///< of its position loops
  double load_effects = 1;  ///< nominal amplitude of effects on load and swing sensors / that of the tower
  double second_cable_m = 0.7;  ///< second cable length of the run "two_lengths"
};

/// @param name tower, gantry, drive_axis, pendulum
/// @throws std::invalid_argument that names the existing rigs
[[nodiscard]] Physics rig(std::string_view name);

}  // namespace truth
