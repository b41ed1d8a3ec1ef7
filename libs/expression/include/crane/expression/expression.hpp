#pragma once
/// Expressions of named values, such as the trigger of `crane scope`:
///   abs(state.swing_radial_rad) > 5deg and not rising(supervisor.state == STATE_RUN)
///
/// Operators, weakest first: or; and; not; < <= > >= == != (a < b < c is refused); + -; * /; unary -.
/// Operands: numbers with units (5deg, 20 ms, 0.1 m/s), names, expressions in parentheses, abs(x), min(x,
/// ...), max(x, ...), rising(condition). Values are in SI units. Both operands of a comparison, sum or
/// difference have the same dimension; a number without unit has the SI unit of the other operand. rising(c)
/// is true in the row in which c becomes true. rising(c) is unknown while c is unknown, and in the first
/// known row of c if c is true there.
///
/// A missing value is NaN. A comparison with a missing value is unknown. `and`, `or`, `not` follow Kleene's
/// logic: (false and unknown) is false, (true or unknown) is true. A quotient, product, sum or difference
/// that is not finite (a division by zero, an overflow) is a missing value.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "crane/fields/unit.hpp"

namespace crane::expression {

/// Kind of a value.
struct Type {
  enum class Kind : std::uint8_t { quantity, condition, enumeration };
  Kind kind = Kind::quantity;
  fields::Dimension dimension{};  ///< of a quantity
  std::string enumeration{};      ///< name of the enumeration
  bool operator==(const Type&) const = default;
};

/// Meaning of a name: a constant, or a field of a row.
struct Symbol {
  Type type{};
  bool constant = false;
  double value = 0;        ///< of a constant
  std::size_t column = 0;  ///< of a field: index in the row of values
  double factor = 1;       ///< of a field: SI value of one unit of the column
};

/// Finds the meaning of the names in an expression.
struct Vocabulary {
  std::function<std::optional<Symbol>(std::string_view name)> find;
  /// Message for an unknown name: "no topic 'stat'; did you mean state?"
  std::function<std::string(std::string_view name)> explain;
};

/// Largest number of bytes of an expression, and largest number of reported problems: both limit the length
/// of the message.
inline constexpr std::size_t kLongestText = 4096, kMostProblems = 20;

struct Problem {
  std::size_t position = 0;  ///< first character, from 0
  std::string what;          ///< names the value and the rule
};

/// what() states each problem: the expression, a mark below the wrong character, and the rule.
class Error : public std::runtime_error {
 public:
  Error(std::string_view text, std::vector<Problem> problems);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// Memory of an evaluation between rows.
struct Memory {
  std::vector<double> previous;  ///< last known condition of each rising()
  std::vector<double> stack;     ///< work space of evaluate()
};

class Expression {
 public:
  /// @throws Error with the first kMostProblems problems
  Expression(std::string_view text, const Vocabulary& vocabulary);

  [[nodiscard]] const Type& type() const { return type_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] Memory memory() const;
  /// @param row  values by Symbol::column
  /// @return value in SI units; of a condition: 1 (true), 0 (false) or NaN (unknown)
  [[nodiscard]] double evaluate(std::span<const double> row, Memory& memory) const;

  enum class Code : std::uint8_t {
    number,
    column,
    negate,
    add,
    subtract,
    multiply,
    divide,
    absolute,
    smaller,  // of two
    larger,   // of two
    less,
    less_equal,
    greater,
    greater_equal,
    equal,
    unequal,
    both,
    either,
    invert,
    rising
  };
  /// One operation on the stack of values.
  struct Step {
    Code code = Code::number;
    double value = 0;       ///< number; factor of a column
    std::size_t index = 0;  ///< column; number of the rising()
  };

 private:
  std::string text_;
  Type type_;
  std::vector<Step> steps_;
  std::size_t risings_ = 0;
};

/// @return an expression of the kind `condition`. @throws Error also when `text` is not a condition
[[nodiscard]] Expression condition(std::string_view text, const Vocabulary& vocabulary);

}  // namespace crane::expression
