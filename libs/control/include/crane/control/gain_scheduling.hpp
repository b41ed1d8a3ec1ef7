#pragma once
/// Gain-scheduling feedback in closed form, exact for the linear models (2.28)-(2.31).
/// Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, section 3.2.
/// Signs: docs/equations.md#coordinates-and-signs.
///
///   V_x     = K (x_r     - x     - K_x'     x'     - K_phi   phi   - K_phi'   phi'  )      (3.26)
///   V_gamma = K (gamma_r - gamma - K_gamma' gamma' + K_theta theta + K_theta' theta')
///
/// The closed loop of each axis is, with zeta = 1/sqrt(2),
///   (s + a)^2 (s^2 + sqrt(2) w s + w^2) = 0                                         (3.20)
///   a = (2/pi) w0 (3.21),  w0 = sqrt(g/L),  w = (pi/2) sqrt(K K_m)  from (3.25) with K_x = 1,
///   K_x'   = 2/a + sqrt(2)/w                                                        from (3.24),
///   K_phi  = L ((a^2 + 2 sqrt(2) a w + w^2 - w0^2 (1 + m_t)) / (K K_m) - 1)         from (3.23),
///   K_phi' = L ((2 a + sqrt(2) w) / (K K_m) - K_x')                                 from (3.22).
/// Partial-state feedback (3.19) has no K_phi'. The condition K_phi' = 0 determines w/w0 and therefore K.
/// Full-state feedback has a free K; forward_gains() lowers K for long moves, so that the first command stays
/// within the voltage limit of the drive. The slew axis has the same form with K_m / (1 + M_r x^2) for K_m,
/// m_r x^2 / (1 + M_r x^2) for m_t, and swing gains divided by x.
#include <array>
#include <memory>

#include "crane/control/law.hpp"
#include "crane/control/schedule.hpp"

namespace crane::control {

/// Linear model of one axis with swing: q'' + m_t g swing = K_m V, L swing'' + g swing = q''.
struct SwingAxis {
  double gravity_mps2 = 9.81;  ///< g, > 0
  double cable_length_m = 1;   ///< L, > 0
  double drive_gain = 2;       ///< K_m, m/s^2 or rad/s^2 per volt, > 0
  double load_ratio = 0;       ///< m_t, >= 0
};

struct Gains {
  double position = 0;    ///< K, V/m or V/rad
  double speed = 0;       ///< K_x' or K_gamma', s
  double swing = 0;       ///< K_phi, m/rad, or K_theta, rad/rad
  double swing_rate = 0;  ///< K_phi' or K_theta'
};

struct TowerGains {
  Gains trolley, slew;
};

[[nodiscard]] SwingAxis trolley_axis(const plant::Parameters& crane, double cable_length_m) noexcept;
[[nodiscard]] SwingAxis slew_axis(const plant::Parameters& crane, double cable_length_m,
                                  double trolley_position_m) noexcept;

/// Partial-state feedback: the axis determines K. @pre every field of axis is inside its range
[[nodiscard]] Gains partial_state_gains(const SwingAxis& axis) noexcept;
/// Full-state feedback for a given forward gain K, V/m or V/rad. @pre forward_gain > 0
[[nodiscard]] Gains full_state_gains(const SwingAxis& axis, double forward_gain) noexcept;

/// Largest forward gain K, V/m or V/rad, for which the first command V(0) = K |distance| of a step does not
/// exceed `volt_limit_v`; at most `gain_limit`. @param distance  m or rad. @pre gain_limit, volt_limit_v > 0
[[nodiscard]] double forward_gain_within(double volt_limit_v, double distance, double gain_limit) noexcept;

/// Voltage that the friction compensation leaves for the control law at the start of a move, V: the limit of
/// the drive minus `factor` times the larger of stiction and Coulomb friction in the direction of motion.
/// Positive when the design has no problems. @param positive  direction of motion
[[nodiscard]] double available_control_v(const Design& design, plant::Axis axis, bool positive) noexcept;

/// Forward gain K of each axis.
struct ForwardGains {
  double trolley = 0;  ///< V/m
  double slew = 0;     ///< V/rad
};

/// Forward gain of the full-state feedback for the present move: the largest K up to
/// full_state_forward_gain_vpm with K |reference - start| <= available_control_v(). Tracking and anti-swing
/// get reference and start from the same crane/reference, and therefore the same K.
[[nodiscard]] ForwardGains forward_gains(const Design& design, const Reference& reference) noexcept;

/// Gains of both axes at one operating point. The swing gains of the slew axis are K_phi, K_phi' times
/// inverse_position_pm.
[[nodiscard]] TowerGains partial_state_gains(const Design& design, const Schedule& at) noexcept;
/// @pre forward_gains > 0
[[nodiscard]] TowerGains full_state_gains(const Design& design, const Schedule& at,
                                          const ForwardGains& forward_gains) noexcept;

[[nodiscard]] std::unique_ptr<Law> make_partial_tracking(const Design& design);
[[nodiscard]] std::unique_ptr<Law> make_partial_anti_swing(const Design& design);
[[nodiscard]] std::unique_ptr<Law> make_full_tracking(const Design& design);
[[nodiscard]] std::unique_ptr<Law> make_full_anti_swing(const Design& design);

}  // namespace crane::control
