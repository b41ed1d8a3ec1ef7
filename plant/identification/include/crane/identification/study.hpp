#pragma once
/// Tables 3.1 to 3.5: the regression of section 3.1 on the test problem, for several zero-velocity bands and
/// cut-off frequencies. The source leaves open how it simulated; this is the reading that agrees best: 100
/// Hz, 60 s, continuous PD, x and u filtered, v from the model.
#include <array>
#include <string>
#include <vector>

#include "crane/identification/test_problem.hpp"

namespace crane::identification {

/// b+, b-, c+, c- over K_m.
using Coefficients = std::array<double, 4>;

struct StudyRow {
  std::string table;     ///< "3.1"
  std::string variable;  ///< "d_s", m/s, or "omega_c", Hz
  double value = 0;
  Coefficients printed{};
  Coefficients recomputed{};
  Coefficients midpoint{};  ///< the unbiased form on the same axis with a held voltage
  /// The source's number depends on how its integrator chattered about v = 0, which cannot be repeated.
  bool printed_chatters = false;
};

/// All rows in the order of the source.
[[nodiscard]] std::vector<StudyRow> recompute_tables();

/// The truth of a table's rows.
[[nodiscard]] Coefficients exact(const StudyRow& row);

}  // namespace crane::identification
