#pragma once
/// Checks of the input of all estimators.
#include <string>

#include "crane/identification/friction.hpp"

namespace crane::identification {

/// Shortest decimal text: "0.05".
[[nodiscard]] std::string text(double value);

/// @throws std::invalid_argument unless `value` > 0
void require_positive(const char* name, double value);

/// @throws IdentificationError when a series is too short, not finite or of another length
void check_series(const AxisRun& run);

}  // namespace crane::identification
