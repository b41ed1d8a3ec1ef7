#pragma once
/// Scheduling variables of the laws, with their limits, and the normalisation of section 3.3. Source: H. M.
/// Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003; docs/equations.md lists the errata.
#include "crane/control/law.hpp"

namespace crane::control {

/// Operating point of one tick.
struct Schedule {
  double cable_length_m = 1;      ///< measured L, limited to [shortest, longest] of the design
  double trolley_position_m = 1;  ///< measured x
  /// 1/x in 1/m, limited near the tower, where the slew drive has little effect on the load and 1/x tends to
  /// infinity: x / minimum^2 for |x| < minimum_trolley_position_m. The limited gain is continuous and odd in
  /// x, at most 1/minimum, and 0 at x = 0.
  double inverse_position_pm = 1;
  double load_period_s = 1;  ///< T = 2 pi sqrt(L/g)
};

[[nodiscard]] Schedule schedule(const Design& design, const Measurement& measured) noexcept;

/// Limits every value to +-1e6, so that no finite input can overflow. NaN stays NaN.
[[nodiscard]] Measurement bounded(const Measurement& measured) noexcept;
[[nodiscard]] Reference bounded(const Reference& reference) noexcept;

/// Volts for the normalised trolley acceleration Vbar_x, first part of (3.37):
///   V_x = L / (K_mx T^2) Vbar_x
[[nodiscard]] double trolley_volts(const plant::Parameters& crane, const Schedule& at,
                                   double vbar_x) noexcept;

/// Volts for the normalised acceleration Vbar_y of y = -(x/L) gamma (3.34), first part of (3.38):
///   V_gamma = -L (1 + M_r x^2) / (K_mgamma x T^2) Vbar_y
[[nodiscard]] double slew_volts(const plant::Parameters& crane, const Schedule& at, double vbar_y) noexcept;

/// Volts that cancel the force of the load on each drive, second parts of (3.37) and (3.38):
///   trolley  m_t g phi / K_mx,   slew  -m_r g x theta / K_mgamma
[[nodiscard]] Volts load_force_volts(const plant::Parameters& crane, const Measurement& measured) noexcept;

}  // namespace crane::control
