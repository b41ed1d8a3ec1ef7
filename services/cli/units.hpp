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

/// Parses a long time: as parse_quantity(), and also with the units min, h and d. @return s
/// @throws UnitError, also when the time is not positive
[[nodiscard]] double parse_duration(std::string_view text);

/// Parses a size: "500MB", "2 GB", "1GiB", "4096". @return bytes. @throws UnitError, also when it is 0
[[nodiscard]] std::uint64_t parse_bytes(std::string_view text);

}  // namespace crane::cli
