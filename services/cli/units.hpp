#pragma once
/// Parses lengths and angles of the command line: "1.05", "105cm", "90deg".
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace crane::cli {

enum class Dimension : std::uint8_t { length, angle };

/// The text is not a finite number, or has a wrong unit. what() lists the permitted units.
class UnitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses a finite number without unit or with m, cm, mm (length), rad, deg (angle); blanks before the unit
/// are permitted.
/// @return m or rad. @throws UnitError
[[nodiscard]] double parse_quantity(std::string_view text, Dimension dimension);

}  // namespace crane::cli
