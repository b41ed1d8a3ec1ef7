#pragma once
/// Gain-scheduling feedback of section 3.2 in closed form, exact for (2.28)-(2.31).
///
/// V_x     = K (x_r     - x     - K_x'     x'     - K_phi   phi   - K_phi'   phi'  )      (3.26), tower sign
/// V_gamma = K (gamma_r - gamma - K_gamma' gamma' + K_theta theta + K_theta' theta')
///
/// puts the poles of each axis at (s + a)^2 (s^2 + sqrt(2) w s + w^2), (3.20) with zeta = 1/sqrt(2), where
///   a = (2/pi) w0 (3.21),  w0 = sqrt(g/L),  w = (pi/2) sqrt(K K_m)  from (3.25) with K_x = 1,
///   K_x'   = 2/a + sqrt(2)/w                                                        from (3.24),
///   K_phi  = L ((a^2 + 2 sqrt(2) a w + w^2 - w0^2 (1 + m_t)) / (K K_m) - 1)         from (3.23),
///   K_phi' = L ((2 a + sqrt(2) w) / (K K_m) - K_x')                                 from (3.22).
/// Partial feedback (3.19) has no K_phi'; K_phi' = 0 fixes w/w0 and with it K. Full feedback leaves K free:
/// it is lowered for a move that is too long for the volts (ForwardGain). The slew axis has the same form
/// with K_m / (1 + M_r x^2), m_r x^2 / (1 + M_r x^2) and swing gains over x.
#include <array>
#include <memory>

#include "crane/control/law.hpp"
#include "crane/control/schedule.hpp"

namespace crane::control {

/// One axis as the design sees it: q'' + m_t g swing = K_m V, L swing'' + g swing = q''.
struct SwingAxis {
  double gravity_mps2 = 9.81;  ///< g, > 0
  double cable_length_m = 1;   ///< L, > 0
  double drive_gain = 2;       ///< K_m, per volt, > 0
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

/// Partial-state feedback: K follows from the crane. @pre every field of axis in its range
[[nodiscard]] Gains partial_state_gains(const SwingAxis& axis) noexcept;
/// Full-state feedback for a chosen forward gain K. @pre forward_gain > 0
[[nodiscard]] Gains full_state_gains(const SwingAxis& axis, double forward_gain) noexcept;

/// Largest forward gain, at most `gain_limit`, with which a step of `distance` asks for no more than
/// `volt_limit_v` as it begins: V(0) = K distance. @pre gain_limit, volt_limit_v > 0
[[nodiscard]] double forward_gain_within(double volt_limit_v, double distance, double gain_limit) noexcept;

/// Volts of one axis that its friction compensation leaves for a move as it begins: the limit less the larger
/// of stiction and Coulomb friction of the direction, times the compensated share. > 0 for a design without
/// problems.
[[nodiscard]] double volts_left_v(const Design& design, plant::Axis axis, bool positive) noexcept;

/// K of both slewing and trolley, V/m and V/rad.
struct ForwardGains {
  double trolley = 0, slew = 0;
};

/// K of the full-state feedback for the move under way. K is recomputed whenever the reference of an axis
/// changes: it is full_feedback_gain_pm where K (reference - position) stays within volts_left_v(), and
/// smaller for longer distances. While the reference rests, K is constant. Tracking and anti-swing each hold
/// a ForwardGain: the same samples in the same order give both the same K, bit for bit. A process that missed
/// the tick of the change recomputes K at the next tick; a crane at rest has not moved by then.
class ForwardGain {
 public:
  explicit ForwardGain(const Design& design) noexcept;
  [[nodiscard]] ForwardGains step(const Design& design, const Measurement& measured,
                                  const Reference& reference) noexcept;
  /// Treats the next reference as a new one.
  void reset() noexcept;

 private:
  std::array<double, 2> target_{}, gain_{};  ///< trolley, slew
};

/// Both axes at one operating point; the slew axis' swing gains are K_phi, K_phi' times inverse_position_pm.
[[nodiscard]] TowerGains partial_state_gains(const Design& design, const Schedule& at) noexcept;
/// @pre forward_gains > 0
[[nodiscard]] TowerGains full_state_gains(const Design& design, const Schedule& at,
                                          const ForwardGains& forward_gains) noexcept;

[[nodiscard]] std::unique_ptr<Law> make_partial_tracking(const Design& design);
[[nodiscard]] std::unique_ptr<Law> make_partial_anti_swing(const Design& design);
[[nodiscard]] std::unique_ptr<Law> make_full_tracking(const Design& design);
[[nodiscard]] std::unique_ptr<Law> make_full_anti_swing(const Design& design);

}  // namespace crane::control
