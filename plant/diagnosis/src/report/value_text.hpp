#pragma once
/// Numbers and estimates as text of the report.
#include <string>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {

/// `digits` significant digits, below 1e7 without an exponent; "-" when the value is not finite.
[[nodiscard]] std::string significant(double value, int digits = 4);
/// "12.3 %"
[[nodiscard]] std::string percent(double share);
/// "0.12 ± 0.01 V": value and standard deviation.
[[nodiscard]] std::string with_std(const Estimate& e);
/// "delay_s 0.03 [0.028, 0.032] s, ...": values and 95 % intervals.
[[nodiscard]] std::string with_intervals(const std::vector<Estimate>& estimates);
/// "level_v 0.12 V, ..."
[[nodiscard]] std::string plain_values(const std::vector<Estimate>& estimates);

}  // namespace crane::diagnosis
