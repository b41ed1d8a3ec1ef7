#pragma once
/// Is there anything left that no candidate explains? Drives: an extra voltage that is free in every bin of
/// position, speed, way since the last reversal, other command ..., tried one variable after the other, out
/// of sample.
#include <string>
#include <vector>

#include "force/pieces.hpp"

namespace crane::diagnosis {

struct Unexplained {
  std::string variable;  ///< "trolley: position", ...
  double gain = 0;       ///< decrease of the loss, cross-validated
  double fraction = 0;   ///< of the pieces' loss
  bool of_load = false;  ///< one frequency in the swing
};

/// Strongest first; only those that predict.
/// @param pieces of a drive
[[nodiscard]] std::vector<Unexplained> find_unexplained(const Pieces& pieces);

}  // namespace crane::diagnosis
