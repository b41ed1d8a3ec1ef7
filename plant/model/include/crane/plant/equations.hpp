#pragma once
/// Equations of motion of the tower crane, (2.11)-(2.20):
///   M(q) q'' + h(q, q', L', L'') = F,   q = (x, phi, gamma, theta)
/// The cable length L is a prescribed motion: the hoist drive is speed-controlled, and the load does not
/// affect it. The slew axis is vertical; terms may tilt the jib out of the horizontal. A gantry is a tower
/// crane with slew and tangential swing locked. A single drive axis has no load mass. A free pendulum has all
/// drives locked. Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, chapter 2,
/// with the misprints corrected (docs/equations.md).
#include "crane/plant/motion_terms.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/plant/state.hpp"

namespace crane::plant {

/// Generalised forces (2.15) on (x, phi, gamma, theta): N, N m, N m, N m.
struct Forces {
  double trolley_n = 0;
  double radial_nm = 0;
  double slew_nm = 0;
  double tangential_nm = 0;
};

struct Accelerations {
  double trolley_mps2 = 0;
  double radial_radps2 = 0;
  double slew_radps2 = 0;
  double tangential_radps2 = 0;
  double cable_mps2 = 0;
};

/// Locked coordinates: held by a closed brake, absent from the rig, or with a prescribed motion.
struct Locks {
  std::array<bool, kAxes> axis{};
  /// Acceleration of each locked axis: 0 for an axis that a brake holds (its rate must be 0), otherwise
  /// prescribed.
  PerAxis acceleration{};
  bool radial = false;      ///< true: phi is held
  bool tangential = false;  ///< true: theta is held
};

/// Sines and cosines of the swing angles; without a load those of 0, because the swing then does not affect
/// the drives.
[[nodiscard]] motion::Angles<double> swing_angles(const Parameters& parameters, const State& state) noexcept;

/// @return q'' of the free coordinates; for a locked axis the acceleration in `locks`. Without load mass, the
///   swing is locked too, because its equations vanish
/// @param cable_mps2  L'', prescribed; a locked hoist uses its acceleration in `locks` instead
/// @pre parameters.problems().empty(), cable length > 0, |theta| < pi/2
[[nodiscard]] Accelerations accelerations(const Parameters& parameters, const State& state,
                                          const Forces& forces, double cable_mps2,
                                          const Locks& locks = {}) noexcept;

/// The equations of motion at one state, M(q) q'' = F - h. They are linear in q'' and F, so that an
/// integrator can solve them for several forces.
struct MotionEquations {
  motion::Mass<double> mass;
  Forces net;             ///< F - h; 0 for a locked coordinate
  double cable_mps2 = 0;  ///< L''
};
/// Arguments as for accelerations(). @param angles  swing_angles(parameters, state)
[[nodiscard]] MotionEquations motion_equations(const Parameters& parameters, const State& state,
                                               const motion::Angles<double>& angles, const Forces& forces,
                                               double cable_mps2, const Locks& locks) noexcept;
/// @return as accelerations()
[[nodiscard]] Accelerations solution(const MotionEquations& equations, const Locks& locks) noexcept;

/// Additional swing accelerations when the suspension point has the additional accelerations `trolley_mps2`
/// (along the jib) and `slew_radps2`.
struct SwingResponse {
  double radial_radps2 = 0;
  double tangential_radps2 = 0;
};
[[nodiscard]] SwingResponse swing_response(const motion::Mass<double>& mass, double trolley_mps2,
                                           double slew_radps2, const Locks& locks) noexcept;

/// Accelerations of the unlocked drives per unit of force on the trolley (N) and of torque on the slew axis
/// (N m).
struct DriveResponse {
  double trolley_mps2_pn = 0;
  double slew_radps2_pnm = 0;
  double coupling = 0;  ///< trolley m/s2 per N m, equal to slew rad/s2 per N because M is symmetric
};
[[nodiscard]] DriveResponse drive_response(const Parameters& parameters, const State& state,
                                           const Locks& locks = {}) noexcept;

/// Tension of the cable [N], positive for a taut cable: -Q_L of Lagrange's equation for L. The tension is
/// linear in the accelerations of trolley, jib and cable.
struct CableTension {
  double free_n = 0;  ///< without accelerations
  double by_trolley_kg = 0, by_slew_kgm = 0, by_cable_kg = 0;

  [[nodiscard]] double tension_n(const Accelerations& a) const noexcept {
    return free_n + by_trolley_kg * a.trolley_mps2 + by_slew_kgm * a.slew_radps2 + by_cable_kg * a.cable_mps2;
  }
};
[[nodiscard]] CableTension cable_tension(const Parameters& parameters, const State& state) noexcept;
/// @param level  sines and cosines of the angles of the cable in the slewing frame
[[nodiscard]] CableTension cable_tension(const Parameters& parameters, const State& state,
                                         const motion::Angles<double>& level) noexcept;

/// State after an end stop has stopped `axis` in an inelastic impact. The impulse changes the rates of the
/// other free coordinates f: M_ff dq'_f = -M_fs dq'_s with s the stopped coordinate.
[[nodiscard]] State stop_dead(const Parameters& parameters, const State& state, Axis axis,
                              const Locks& locks = {}) noexcept;

/// Kinetic (2.13) plus potential (2.14) energy [J]; 0 for a crane at rest with trolley and load at the height
/// of the tower end of the jib.
[[nodiscard]] double energy_j(const Parameters& parameters, const State& state) noexcept;

/// Equations of the gantry, (2.5), (2.6), with the swing sign of the source's gantry chapter:
/// r_L = {x + L sin(phi), -L cos(phi)}, hence phi = -State::radial_rad. The equations do not
/// depend on position and speed of the trolley.
/// @pre load mass > 0
struct GantryState {
  double swing_rad = 0;    ///< phi of the gantry chapter: positive with the load ahead of the trolley
  double swing_radps = 0;  ///< rate of swing_rad
  double cable_m = 1;      ///< L > 0
  double cable_mps = 0;    ///< L'
};
struct GantryAccelerations {
  double trolley_mps2 = 0;
  double swing_radps2 = 0;
};
/// @param cable_mps2  L'' @param force_n  force of the drive on the trolley
[[nodiscard]] GantryAccelerations gantry_accelerations(const Parameters& parameters, const GantryState& state,
                                                       double cable_mps2, double force_n) noexcept;

}  // namespace crane::plant
