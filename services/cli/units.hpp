#pragma once
/// Parses lengths, angles and times of the command line: "1.05", "105cm", "90deg", "20ms".
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace crane::cli {

enum class Dimension : std::uint8_t { length, angle, time };

/// The text is not a finite number, or has a wrong unit. what() lists the permitted units.
class UnitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses a finite number without unit, or with a unit of the dimension (crane/fields/unit.hpp); blanks
/// before the unit are permitted.
/// @return m, rad or s. @throws UnitError
[[nodiscard]] double parse_quantity(std::string_view text, Dimension dimension);

}  // namespace crane::cli
