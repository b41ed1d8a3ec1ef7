#include "report/value_text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace crane::diagnosis {
namespace {

constexpr double kNormalQuantile95 = 1.96;
constexpr double kLargestPlain = 1e7;  // largest number without an exponent

std::string unit_of(const Estimate& e) { return e.unit.empty() || e.unit == "1" ? "" : " " + e.unit; }

}  // namespace

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 32> text{};
  // 44210, not 4.421e+04.
  const bool is_large = std::abs(value) >= std::pow(10, digits) && std::abs(value) < kLargestPlain;
  if (is_large)
    std::snprintf(text.data(), text.size(), "%.0f", value);
  else
    std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string with_std(const Estimate& e) {
  return significant(e.value) + " ± " + significant(e.std_dev, 2) + unit_of(e);
}

std::string with_intervals(const std::vector<Estimate>& estimates) {
  std::string text;
  for (const Estimate& e : estimates)
    text += (text.empty() ? "" : ", ") + e.name + " " + significant(e.value, 3) + " [" +
            significant(e.value - kNormalQuantile95 * e.std_dev, 3) + ", " +
            significant(e.value + kNormalQuantile95 * e.std_dev, 3) + "]" + unit_of(e);
  return text;
}

std::string percent(double share) { return significant(100 * share, 3) + " %"; }

std::string plain_values(const std::vector<Estimate>& estimates) {
  std::string text;
  for (const Estimate& e : estimates)
    text += (text.empty() ? "" : ", ") + e.name + " " + significant(e.value, 3) + unit_of(e);
  return text;
}

}  // namespace crane::diagnosis
