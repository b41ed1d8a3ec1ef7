#pragma once
/// Equations of motion of the tower crane, (2.11)-(2.20), M(q) q'' + h(q, q', L', L'') = F with q = (x, phi,
/// gamma, theta). The cable length is a prescribed motion: its drive is speed-controlled and does not feel
/// the load. A gantry is the tower with slew and tangential swing locked; a single drive axis has no load
/// mass; a free pendulum has all drives locked. Source: H. M. Omar, Control of Gantry and Tower Cranes,
/// chapter 2, with the misprints corrected.
#include <Eigen/Core>

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

/// Coordinates held by a closed brake, or that the rig does not have, or whose motion is given.
struct Locks {
  std::array<bool, kAxes> axis{};
  PerAxis acceleration{};  ///< of a locked axis: 0 when held (its rate is 0 then), else its given motion
  bool radial = false;
  bool tangential = false;
};

/// q'' of the free coordinates; for the locked ones 0 or what is given. Without load mass the swing is locked
/// too (the pendulum equations are empty then).
/// @param cable_mps2 L'', prescribed; that of the lock when the hoist is locked
/// @pre parameters.problems().empty(), cable length > 0, |theta| < pi/2
[[nodiscard]] Accelerations accelerations(const Parameters& parameters, const State& state,
                                          const Forces& forces, double cable_mps2,
                                          const Locks& locks = {}) noexcept;

/// What the swing accelerations gain when the point the cable hangs from is accelerated beyond x'' and
/// gamma''.
struct SwingResponse {
  double radial_radps2 = 0;
  double tangential_radps2 = 0;
};
[[nodiscard]] SwingResponse swing_response(const Parameters& parameters, const State& state,
                                           double trolley_mps2, double slew_radps2,
                                           const Locks& locks = {}) noexcept;

/// What the accelerations of the drives that are not locked gain per N on the trolley and N m on the slew.
struct DriveResponse {
  double trolley_mps2_pn = 0;
  double slew_radps2_pnm = 0;
  double coupling = 0;  ///< trolley m/s2 per N m and slew rad/s2 per N, the same by the symmetry of M
};
[[nodiscard]] DriveResponse drive_response(const Parameters& parameters, const State& state,
                                           const Locks& locks = {}) noexcept;

/// Force that keeps the cable at its length [N], > 0 while it is taut: -Q_L of Lagrange's equation for L.
[[nodiscard]] double cable_tension_n(const Parameters& parameters, const State& state,
                                     const Accelerations& accelerations) noexcept;

/// The state just after `axis` was stopped dead by an end stop: the rates of the other free coordinates take
/// up the impulse, M_ff dq'_f = -M_fs dq'_s.
[[nodiscard]] State stop_dead(const Parameters& parameters, const State& state, Axis axis,
                              const Locks& locks = {}) noexcept;

/// M(q), symmetric, rows and columns (x, phi, gamma, theta).
[[nodiscard]] Eigen::Matrix4d mass_matrix(const Parameters& parameters, const State& state) noexcept;

/// Columns d r_L' / d q' in the jib frame [m]: a force on the load, times this, is its generalised force.
[[nodiscard]] Eigen::Matrix<double, 3, 4> load_jacobian(const State& state) noexcept;

/// Velocity of the load over ground in the jib frame, (2.12), cable speed included [m/s].
[[nodiscard]] Eigen::Vector3d load_velocity_mps(const State& state) noexcept;

/// Kinetic (2.13) plus potential (2.14) energy [J]; 0 for a crane at rest with the load at jib height.
[[nodiscard]] double energy_j(const Parameters& parameters, const State& state) noexcept;

/// Gantry (2.5), (2.6) in the dissertation's gantry sign of the swing: r_L = {x + L sin(phi), -L cos(phi)},
/// so phi is the negative of State::radial_rad. @pre load mass > 0
struct GantryAccelerations {
  double trolley_mps2 = 0;
  double swing_radps2 = 0;
};
[[nodiscard]] GantryAccelerations gantry_accelerations(const Parameters& parameters, double swing_rad,
                                                       double swing_radps, double cable_m, double cable_mps,
                                                       double cable_mps2, double force_n) noexcept;

/// d(state)/dt = a state + b volts of one drive with its swing: (x, phi, x', phi') or (gamma, theta, gamma',
/// theta').
struct LinearModel {
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
};
/// (2.28), (2.29)
[[nodiscard]] LinearModel linear_translation(const Parameters& parameters, double cable_m) noexcept;
/// (2.30), (2.31) at a fixed trolley position, M_r = M_j / J_o, m_r = m / J_o
[[nodiscard]] LinearModel linear_rotation(const Parameters& parameters, double trolley_m,
                                          double cable_m) noexcept;

}  // namespace crane::plant
