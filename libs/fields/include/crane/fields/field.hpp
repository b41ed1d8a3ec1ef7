#pragma once
/// Describes one number, switch, text or choice in a section of a rig file. The tables of fields are declared
/// beside the structs that they describe. Reader, writer and checks of rig files, and the tables in
/// docs/rig_file.md, use them.
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "crane/fields/range.hpp"

namespace crane::fields {

/// Quantity that the number measures. Every quantity except `fixed` adds a unit to the key, according to the
/// coordinate of the section.
enum class Quantity { fixed, position, speed, acceleration, jerk, volts_per_speed };

/// When a file must contain the field.
enum class Presence {
  optional,
  required,
  required_with_load,
  required_with_trolley,
  required_with_slew,
  required_with_hoist
};

/// One element of an array that has one number per drive.
template <class Section>
struct Element {
  std::array<double, 3> Section::*array;
  std::size_t index;
};

/// A set of drives, written as an array of their names.
template <class Section>
struct AxisSet {
  std::array<bool, 3> Section::*member;
};

/// One of several names.
template <class Section>
struct Choice {
  std::vector<std::string> (*names)();
  std::size_t (*get)(const Section&);
  void (*set)(Section&, std::size_t);
};

template <class Section>
using Member = std::variant<double Section::*, int Section::*, bool Section::*, std::string Section::*,
                            Element<Section>, AxisSet<Section>, Choice<Section>>;

template <class Section>
struct Field {
  std::string_view key;  ///< without the unit that `quantity` adds
  Member<Section> member;
  Range range{};             ///< of numbers
  std::string_view unit{};   ///< as the documents print it; empty: `quantity` gives it
  std::string_view meaning;  ///< one line for the document
  Presence presence = Presence::optional;
  Quantity quantity = Quantity::fixed;
  std::string_view default_text{};     ///< for the document; empty: the value of a new Section
  std::string_view choices_text = {};  ///< of a Choice: replaces the list of its names in the document
  double (*derived)(const Section&) = nullptr;  ///< default that depends on earlier fields of the table
};

/// "mps" for the speed of a coordinate in "m"; nothing for a fixed quantity.
[[nodiscard]] constexpr std::string_view suffix(Quantity quantity, std::string_view unit) {
  const bool angle = unit == "rad";
  switch (quantity) {
    case Quantity::fixed:
      return {};
    case Quantity::position:
      return angle ? "rad" : "m";
    case Quantity::speed:
      return angle ? "radps" : "mps";
    case Quantity::acceleration:
      return angle ? "radps2" : "mps2";
    case Quantity::jerk:
      return angle ? "radps3" : "mps3";
    case Quantity::volts_per_speed:
      return angle ? "vsprad" : "vspm";
  }
  return {};
}

/// "low_limit" of a coordinate in metres is "low_limit_m".
template <class Section>
[[nodiscard]] std::string key_of(const Field<Section>& field, std::string_view unit) {
  const auto added = suffix(field.quantity, unit);
  return added.empty() ? std::string{field.key} : std::string{field.key} + '_' + std::string{added};
}

/// Value of a floating-point field; nullptr for any other field.
template <class Section>
[[nodiscard]] const double* number_of(const Field<Section>& field,
                                      const std::type_identity_t<Section>& section) {
  if (const auto* member = std::get_if<double Section::*>(&field.member)) return &(section.**member);
  if (const auto* element = std::get_if<Element<Section>>(&field.member))
    return &(section.*element->array)[element->index];
  return nullptr;
}

/// Field with this key. @pre the table has one
template <class Section, std::size_t N>
[[nodiscard]] constexpr const Field<Section>& field_of(const std::array<Field<Section>, N>& table,
                                                       std::string_view key) {
  std::size_t i = 0;
  while (table.at(i).key != key) ++i;
  return table[i];
}

/// Adds "prefix.key = value: rule" for every number outside its range.
template <class Section, std::size_t N>
void check(const std::type_identity_t<Section>& section, const std::array<Field<Section>, N>& table,
           const std::string& prefix, std::vector<std::string>& found) {
  for (const auto& field : table) {
    const double* number = number_of(field, section);
    if (number != nullptr && !field.range.contains(*number))
      found.push_back(complaint(prefix + std::string{field.key}, *number, field.range.rule()));
  }
}

}  // namespace crane::fields
