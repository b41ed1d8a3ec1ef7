#pragma once
/// Is there anything left that no candidate explains? Drives: an extra voltage that is free in every bin of
/// position, speed, way since the last reversal, other command ..., tried one variable after the other, out
/// of sample.
#include <string>
#include <vector>

#include "shooting/problem.hpp"

namespace crane::diagnosis {

struct Unexplained {
  std::string variable;  ///< "trolley: position", ...
  double gain = 0;       ///< decrease of the loss, cross-validated
  double fraction = 0;   ///< of the loss of that output's part
  bool of_load = false;  ///< one frequency in the swing
};

/// Strongest first; only those that predict.
[[nodiscard]] std::vector<Unexplained> find_unexplained(const Problem& drive, const Fits& fits);

}  // namespace crane::diagnosis
