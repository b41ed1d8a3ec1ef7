#pragma once
/// Is there anything left of a drive that no candidate explains? An extra force that is free in every bin of
/// position, speed, way since the last reversal, command ..., tried one variable after the other, out of
/// sample.
#include <string>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
#include "shooting/pieces.hpp"

namespace crane::diagnosis {

struct Unexplained {
  std::string variable;  ///< "trolley: position", ...
  GoesWith with = GoesWith::position;
  Output output = kTrolleyPosition;
  double gain = 0;      ///< decrease of the loss, cross-validated
  double fraction = 0;  ///< of the pieces' loss
};

/// Strongest first; only those that predict.
/// @param pieces of a drive
[[nodiscard]] std::vector<Unexplained> find_unexplained(const Pieces& pieces);

}  // namespace crane::diagnosis
