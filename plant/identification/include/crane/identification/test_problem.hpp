#pragma once
/// The theoretical study of section 3.1: one motor axis with known friction (3.16), stabilised by a PD
/// (3.17), made to follow a sum of two sines (3.18). Equation numbers in this library: H. M. Omar, Control of
/// Gantry and Tower Cranes; corrected forms where docs/equations.md lists an erratum.
#include "crane/identification/friction.hpp"

namespace crane::identification {

/// Coefficients over K_m, in volts: b+/K_m ...
struct FrictionCoefficients {
  double viscous_positive_vspm = 0, viscous_negative_vspm = 0;
  double coulomb_positive_v = 0, coulomb_negative_v = 0;
};

struct TestProblem {
  double gain = 1.7;  ///< K_m, m/s^2 per V
  FrictionCoefficients friction{2.8, 5.5, 1,
                                1.2};  ///< the "exact" rows; the text of section 3.1 contradicts them
  double proportional_vpm = 4.4;       ///< K of V = K (x_ref - x - K_d x') (3.17)
  double derivative_s = 1.33;          ///< K_d
  bool held = false;                   ///< V is sampled and held, as by a computer; else continuous
  double period_s = 0.01;
  double duration_s = 60;
};

/// From rest at 0. Friction is a set: at standstill it takes whatever holds the axis, so the axis sticks
/// without chatter until |V| exceeds it. `speed` of the result is the model's own.
[[nodiscard]] AxisRun simulate(const TestProblem& problem);

}  // namespace crane::identification
