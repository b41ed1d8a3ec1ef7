#pragma once
/// Type of a part of an expression, and the rules of the operators.
#include <optional>

#include "crane/expression/expression.hpp"

namespace crane::expression {

/// What the parser knows of a part of the expression.
struct Operand {
  Type type{};
  bool bare = false;     ///< a number without unit: adopts the quantity of the other side
  bool unknown = false;  ///< its problem has been reported; fits everywhere
};

/// "a quantity in m", "a condition", "a value of SupervisorState"
[[nodiscard]] std::string text_of(const Operand& operand);

/// Operand of an operator or function that needs a quantity. @return problem; nothing: it is one
[[nodiscard]] std::optional<std::string> no_quantity(const Operand& operand, std::string_view of);
[[nodiscard]] std::optional<std::string> no_condition(const Operand& operand, std::string_view of);
/// Unit of a product or quotient. @return problem; nothing: its exponents are small enough to be exact
[[nodiscard]] std::optional<std::string> no_dimension(const fields::Dimension& dimension,
                                                      std::string_view of);
/// Both sides of a comparison, sum or difference. @return problem; nothing: they fit
[[nodiscard]] std::optional<std::string> unequal_quantities(const Operand& a, const Operand& b,
                                                            std::string_view of);

}  // namespace crane::expression
