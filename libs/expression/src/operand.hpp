#pragma once
/// Type of a part of an expression, and the rules of the operators.
#include <optional>

#include "crane/expression/expression.hpp"

namespace crane::expression {

/// Type of a part of the expression.
struct Operand {
  Type type{};
  bool bare = false;     ///< true: a number without unit, which takes the quantity of the other side
  bool unknown = false;  ///< true: a problem of this part has been reported; the part fits every operator
};

/// "a quantity in m", "a condition", "a value of SupervisorState"
[[nodiscard]] std::string text_of(const Operand& operand);

/// Checks the operand of an operator or function that needs a quantity. @return the problem; nothing: the
/// operand is a quantity
[[nodiscard]] std::optional<std::string> no_quantity(const Operand& operand, std::string_view of);
[[nodiscard]] std::optional<std::string> no_condition(const Operand& operand, std::string_view of);
/// Checks the unit of a product or quotient. @return the problem; nothing: the exponents of the unit are
/// within kLargestExponent
[[nodiscard]] std::optional<std::string> no_dimension(const fields::Dimension& dimension,
                                                      std::string_view of);
/// Checks both sides of a comparison, sum or difference. @return the problem; nothing: both sides have the
/// same quantity
[[nodiscard]] std::optional<std::string> unequal_quantities(const Operand& a, const Operand& b,
                                                            std::string_view of);

}  // namespace crane::expression
