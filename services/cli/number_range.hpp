#pragma once
/// Validators of numbers on the command line. They replace CLI::Range and CLI::PositiveNumber, which accept
/// NaN, because a comparison with NaN is false.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace crane::cli {

inline constexpr double kShortestWait_s = 1e-3;
inline constexpr double kLongestWait_s = 86400;  ///< a day; in ns it fits into 64 bits

namespace number_range {

/// @return NaN when the text is no number
[[nodiscard]] inline double value_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' ? value : std::nan("");
}

}  // namespace number_range

/// Accepts a number in [low, high]; refuses any other text, NaN and infinity. @pre low and high are finite
[[nodiscard]] inline CLI::Validator number_in(double low, double high) {
  std::ostringstream range;
  range << '[' << low << ", " << high << ']';
  return CLI::Validator{[low, high, text = range.str()](const std::string& argument) -> std::string {
                          const double value = number_range::value_of(argument);
                          if (value >= low && value <= high) return "";
                          return "'" + argument + "' must be a number in " + text;
                        },
                        "in " + range.str()};
}

/// Accepts a finite number above 0.
[[nodiscard]] inline CLI::Validator positive_number() {
  return CLI::Validator{[](const std::string& argument) -> std::string {
                          const double value = number_range::value_of(argument);
                          if (value > 0 && std::isfinite(value)) return "";
                          return "'" + argument + "' must be a number above 0";
                        },
                        "above 0"};
}

/// Accepts a finite number that is not negative.
[[nodiscard]] inline CLI::Validator not_negative_number() {
  return CLI::Validator{[](const std::string& argument) -> std::string {
                          const double value = number_range::value_of(argument);
                          if (value >= 0 && std::isfinite(value)) return "";
                          return "'" + argument + "' must be 0 or a number above 0";
                        },
                        "not negative"};
}

}  // namespace crane::cli
