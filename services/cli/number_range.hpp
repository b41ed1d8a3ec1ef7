#pragma once
/// Check of a number on the command line. CLI::Range and CLI::PositiveNumber accept NaN, because a comparison
/// with NaN is false.
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <sstream>

namespace crane::cli {

inline constexpr double kShortestWait_s = 1e-3;
inline constexpr double kLongestWait_s = 86400;  ///< a day; in ns it fits into 64 bits

/// Accepts a number in [low, high]; refuses any other text, NaN and infinity. @pre low and high are finite
[[nodiscard]] inline CLI::Validator number_in(double low, double high) {
  std::ostringstream range;
  range << '[' << low << ", " << high << ']';
  return CLI::Validator{[low, high, text = range.str()](const std::string& argument) -> std::string {
                          char* end = nullptr;
                          const double value = std::strtod(argument.c_str(), &end);
                          const bool is_number = end != argument.c_str() && *end == '\0';
                          if (is_number && value >= low && value <= high) return "";
                          return "'" + argument + "' must be a number in " + text;
                        },
                        "in " + range.str()};
}

}  // namespace crane::cli
