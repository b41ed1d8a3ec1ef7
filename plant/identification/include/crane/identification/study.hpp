#pragma once
/// Recomputes Tables 3.1 to 3.5: the regression of section 3.1 on the test problem, with several
/// zero-velocity bands and cut-off frequencies. Source: H. M. Omar, Control of Gantry and Tower Cranes,
/// Virginia Tech, 2003. The source does not state all settings of its simulation. These settings reproduce
/// its tables best: 100 Hz, 60 s, continuous PD, x and u filtered, v from the model.
#include <array>
#include <string>
#include <vector>

#include "crane/identification/test_problem.hpp"

namespace crane::identification {

/// b+, b-, c+, c-, divided by K_m.
using Coefficients = std::array<double, 4>;

struct StudyRow {
  std::string table;     ///< "3.1"
  std::string variable;  ///< "d_s" or "omega_c"
  double value = 0;      ///< d_s in m/s, or omega_c in Hz
  Coefficients printed{};
  Coefficients recomputed{};
  Coefficients midpoint{};  ///< midpoint regression on the same axis with a sampled and held voltage
  /// True: the printed number cannot be reproduced, because the integrator of the source chatters about v =
  /// 0.
  bool printed_chatters = false;
};

/// All rows in the order of the source.
[[nodiscard]] std::vector<StudyRow> recompute_tables();

/// True coefficients of the test problem for a row.
[[nodiscard]] Coefficients exact(const StudyRow& row);

}  // namespace crane::identification
