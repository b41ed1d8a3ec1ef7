#pragma once
/// Splits the text of an expression into numbers with units, names, and operators.
#include <vector>

#include "crane/expression/expression.hpp"

namespace crane::expression {

struct Token {
  enum class Kind : std::uint8_t { number, name, sign, end };
  Kind kind = Kind::end;
  std::string_view text;
  std::size_t position = 0;
  double value = 0;                    ///< number: in SI units
  const fields::Unit* unit = nullptr;  ///< number: nullptr without a unit
};

/// The last token is the end of the text. The function omits text that is not a token and reports it in
/// `problems`.
[[nodiscard]] std::vector<Token> tokens_of(std::string_view text, std::vector<Problem>& problems);

}  // namespace crane::expression
