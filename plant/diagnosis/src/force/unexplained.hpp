#pragma once
/// Pattern of the missing force on a drive or load: a function of one variable, a line, or jumps.
#include <limits>
#include <string>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
#include "shooting/pieces.hpp"

namespace crane::diagnosis {

struct Unexplained {
  std::string variable;  ///< "trolley: position", ...
  GoesWith with = GoesWith::position;
  Output output = kTrolleyPosition;
  double gain = 0;      ///< decrease of the loss; cross-validated except for jumps
  double fraction = 0;  ///< of the pieces' loss
  /// Pattern of a drive over a variable: rms acceleration of the drive by the pattern, m/s2 or rad/s2. Other
  /// patterns: infinite.
  double acceleration = std::numeric_limits<double>::infinity();
  double hz = 0;  ///< of a line; 0 for other patterns
};

/// Patterns with a positive cross-validated gain, strongest first.
/// @param pieces of a drive
[[nodiscard]] std::vector<Unexplained> find_unexplained(const Pieces& pieces);

}  // namespace crane::diagnosis
