#pragma once
/// Simulates the theoretical study of section 3.1: one motor axis with known friction (3.16) and a PD
/// controller (3.17) follows a sum of two sines (3.18). Source: H. M. Omar, Control of Gantry and Tower
/// Cranes, Virginia Tech, 2003; docs/equations.md lists the errata.
#include "crane/identification/friction.hpp"

namespace crane::identification {

/// Coefficients divided by K_m: b+/K_m, b-/K_m, c+/K_m, c-/K_m.
struct FrictionCoefficients {
  double viscous_positive_vspm = 0, viscous_negative_vspm = 0;
  double coulomb_positive_v = 0, coulomb_negative_v = 0;
};

struct TestProblem {
  double gain = 1.7;  ///< K_m, m/s^2 per V
  /// The rows "exact" of the tables; the text of section 3.1 contradicts them (docs/equations.md#errata).
  FrictionCoefficients friction{2.8, 5.5, 1, 1.2};
  double proportional_vpm = 4.4;  ///< K of V = K (x_ref - x - K_d x') (3.17)
  double derivative_s = 1.33;     ///< K_d
  bool held = false;              ///< true: V is sampled and held; false: V is continuous
  double period_s = 0.01;
  double duration_s = 60;
};

/// Simulates from rest at position 0. At standstill the friction balances the drive force up to its limit (a
/// set-valued law), so that the axis sticks without chattering. `speed` of the result is the true speed.
[[nodiscard]] AxisRun simulate(const TestProblem& problem);

}  // namespace crane::identification
