#pragma once
/// What every estimator asks of its series.
#include <string>

#include "crane/identification/friction.hpp"

namespace crane::identification {

/// "0.05"
[[nodiscard]] std::string text(double value);

/// @throws std::invalid_argument unless `value` > 0
void require_positive(const char* name, double value);

/// @throws IdentificationError  too short, of different lengths, or not finite
void check_series(const AxisRun& run);

}  // namespace crane::identification
