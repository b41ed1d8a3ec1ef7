#pragma once
/// Recursive-descent parser of expressions; writes operations on a stack.
#include "operand.hpp"
#include "tokens.hpp"

namespace crane::expression {

struct Program {
  Operand result;
  std::vector<Expression::Step> steps;
  std::size_t risings = 0;
};

/// @throws Error with the first kMostProblems problems
[[nodiscard]] Program parse(std::string_view text, const Vocabulary& vocabulary);

}  // namespace crane::expression
