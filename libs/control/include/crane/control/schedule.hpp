#pragma once
/// What every law is scheduled on, with its guards, and the normalisation of section 3.3.
/// Equation numbers in this library: H. M. Omar, Control of Gantry and Tower Cranes; corrected forms where
/// docs/equations.md lists an erratum.
#include "crane/control/law.hpp"

namespace crane::control {

/// Operating point of one tick.
struct Schedule {
  double cable_length_m = 1;      ///< measured L, held inside [shortest, longest] of the design
  double trolley_position_m = 1;  ///< measured x
  /// 1/x for |x| >= minimum_trolley_position_m, x / minimum^2 below: continuous, odd in x, never larger than
  /// 1/minimum. Near the tower the slew drive moves the load less and less, so the exact gain tends to
  /// infinity; this one tends to zero: swing the slew axis cannot reach is left alone rather than shaken at.
  double inverse_position_pm = 1;
  double load_period_s = 1;  ///< T = 2 pi sqrt(L/g)
};

[[nodiscard]] Schedule schedule(const Design& design, const Measurement& measured) noexcept;

/// Same values, held inside +-1e6 so that no finite input can overflow. NaN stays NaN.
[[nodiscard]] Measurement bounded(const Measurement& measured) noexcept;
[[nodiscard]] Reference bounded(const Reference& reference) noexcept;

/// Volts that give the normalised trolley acceleration Vbar_x, first part of (3.37):
///   V_x = L / (K_mx T^2) Vbar_x
[[nodiscard]] double trolley_volts(const plant::Parameters& crane, const Schedule& at,
                                   double vbar_x) noexcept;

/// Volts that give the normalised acceleration Vbar_y of y = -(x/L) gamma (3.34), first part of (3.38):
///   V_gamma = -L (1 + M_r x^2) / (K_mgamma x T^2) Vbar_y
[[nodiscard]] double slew_volts(const plant::Parameters& crane, const Schedule& at, double vbar_y) noexcept;

/// Volts that cancel the force of the load on its drive, second part of (3.37) and (3.38):
///   trolley  m_t g phi / K_mx,   slew  -m_r g x theta / K_mgamma
[[nodiscard]] Volts load_force_volts(const plant::Parameters& crane, const Measurement& measured) noexcept;

}  // namespace crane::control
