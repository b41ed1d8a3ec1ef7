#pragma once
/// Gains of gain scheduling with partial-state feedback and their closed-loop poles, for comparison with the
/// figures of H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003.
#include <array>
#include <vector>

#include "crane/analysis/quasi_polynomial.hpp"
#include "crane/control/gain_scheduling.hpp"

namespace crane::analysis {

/// Closed-loop poles of an axis with gain scheduling, exact for (2.28)-(2.31):
///   (L s^2 + g)(s^2 + K K_m (1 + K_x' s)) + s^2 (K K_m (K_phi + K_phi' s) + m_t g) = 0
/// The slew axis has the same equation with K_phi = x K_theta.
[[nodiscard]] std::vector<Complex> closed_loop_poles(const control::SwingAxis& axis,
                                                     const control::Gains& gains);

/// One point of a curve.
struct GainSample {
  double abscissa = 0;         ///< L [m], m_t or x [m]
  control::Gains gains;        ///< slew axis: swing gains K_theta = K_phi / x
  std::vector<Complex> poles;  ///< all four poles
};
using GainCurve = std::vector<GainSample>;

/// Figure 3.5: gains over the cable length, 0.5 to 5 m.
/// @param points  number of equally spaced points of the curve, >= 2; also below
[[nodiscard]] GainCurve gains_over_cable_length(const plant::Parameters& crane, int points);
/// Figure 3.6: gains over the mass ratio m_t, 0 to 3, at the given cable length.
[[nodiscard]] GainCurve gains_over_mass_ratio(const plant::Parameters& crane, double cable_length_m,
                                              int points);
/// Figure 3.10: gains of the slew axis over the trolley position, 0.1 to 1.5 m.
[[nodiscard]] GainCurve gains_over_trolley_position(const plant::Parameters& crane, double cable_length_m,
                                                    int points);

/// Parameters of the simulations of section 3.2.2: K_mx = K_mgamma = 1.34, M_r = 0.5.
/// @param load_to_jib_ratio  m_r: 0 in figure 3.5 (m_t = 0), 0.5 in figure 3.10
[[nodiscard]] plant::Parameters figure_parameters(double load_to_jib_ratio);

}  // namespace crane::analysis
