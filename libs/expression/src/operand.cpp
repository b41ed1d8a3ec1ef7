#include "operand.hpp"

#include <cstdlib>

namespace crane::expression {

std::string text_of(const Operand& operand) {
  switch (operand.type.kind) {
    case Type::Kind::condition:
      return "a condition";
    case Type::Kind::enumeration:
      return "a value of " + operand.type.enumeration;
    case Type::Kind::quantity:
      break;
  }
  if (operand.type.dimension == fields::Dimension{}) return "a number without unit";
  return "a quantity in " + fields::text_of(operand.type.dimension);
}

std::optional<std::string> no_quantity(const Operand& operand, std::string_view of) {
  if (operand.unknown || operand.type.kind == Type::Kind::quantity) return std::nullopt;
  return std::string{of} + " needs a quantity, found " + text_of(operand);
}

std::optional<std::string> no_condition(const Operand& operand, std::string_view of) {
  if (operand.unknown || operand.type.kind == Type::Kind::condition) return std::nullopt;
  return std::string{of} + " needs a condition, such as a comparison, found " + text_of(operand);
}

std::optional<std::string> no_dimension(const fields::Dimension& dimension, std::string_view of) {
  constexpr int kLargestExponent = 20;  // far below the largest exponent of a Dimension
  for (const int exponent : {dimension.length, dimension.angle, dimension.time, dimension.voltage})
    if (std::abs(exponent) > kLargestExponent)
      return std::string{of} + " gives the unit " + fields::text_of(dimension) +
             ": its exponents must be in [-" + std::to_string(kLargestExponent) + ", " +
             std::to_string(kLargestExponent) + "]";
  return std::nullopt;
}

std::optional<std::string> unequal_quantities(const Operand& a, const Operand& b, std::string_view of) {
  if (a.unknown || b.unknown || a.type == b.type) return std::nullopt;
  const bool quantities = a.type.kind == Type::Kind::quantity && b.type.kind == Type::Kind::quantity;
  if (quantities && (a.bare || b.bare)) return std::nullopt;
  auto text = "both sides of " + std::string{of} + " must be the same quantity, found " + text_of(a) +
              " and " + text_of(b);
  if (quantities && b.type.dimension != fields::Dimension{} && a.type.dimension != fields::Dimension{})
    text += "; units of the left side: " + fields::symbols_of(a.type.dimension);
  return text;
}

}  // namespace crane::expression
