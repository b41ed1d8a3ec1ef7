#pragma once
/// Lengths and angles as an operator types them: "1.05", "105cm", "90deg".
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace crane::cli {

enum class Dimension : std::uint8_t { length, angle };

/// Not a finite number, or a unit that does not fit; says which units do.
class UnitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A finite number, then nothing, or m, cm, mm (length), rad, deg (angle); blanks between are allowed.
/// @return m or rad. @throws UnitError
[[nodiscard]] double parse_quantity(std::string_view text, Dimension dimension);

}  // namespace crane::cli
