#pragma once
/// Units of numbers in user input ("5deg", "20 ms") and of names ("trolley_speed_mps").
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace crane::fields {

/// Exponents of the base quantities. Angle is a separate base quantity, so that a comparison of an angle with
/// a length or a plain number is an error.
struct Dimension {
  std::int8_t length = 0, angle = 0, time = 0, voltage = 0;
  bool operator==(const Dimension&) const = default;
};
[[nodiscard]] Dimension operator*(Dimension a, Dimension b);
[[nodiscard]] Dimension operator/(Dimension a, Dimension b);

struct Unit {
  std::string_view symbol;  ///< "rad/s"
  std::string_view suffix;  ///< of a name: "radps"
  double factor = 1;        ///< SI value of one unit
  Dimension dimension{};
};
/// All units; the SI unit of a dimension precedes its other units.
[[nodiscard]] std::span<const Unit> units();
/// @return nullptr: no unit has this symbol
[[nodiscard]] const Unit* unit_with_symbol(std::string_view symbol);
/// Unit in which a name ends: that of "trolley_speed_mps" is m/s. @return nullptr: none
[[nodiscard]] const Unit* unit_of_name(std::string_view name);
/// "m/s"; "1" without dimension; "m rad^-1" for a dimension that has no unit in the table
[[nodiscard]] std::string text_of(Dimension dimension);
/// Symbols of all units of a dimension, the SI unit first: "m, cm, mm".
[[nodiscard]] std::string symbols_of(Dimension dimension);

}  // namespace crane::fields
