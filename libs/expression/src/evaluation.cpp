#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "parser.hpp"

namespace crane::expression {
namespace {

using Code = Expression::Code;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double truth(bool value) { return value ? 1 : 0; }

/// `previous` is the last known value of the condition, NaN before the first.
double risen(double condition, double& previous) {
  if (std::isnan(condition)) return kUnknown;
  const double before = std::exchange(previous, condition);
  if (condition == 0 || before == 1) return 0;
  return before == 0 ? 1 : kUnknown;
}

/// A comparison with a value that is not finite is unknown.
double finite(double value) { return std::isfinite(value) ? value : kUnknown; }

/// Operation on two values; of conditions by Kleene's rules.
double combined(Code code, double a, double b) {
  if (code == Code::both) return a == 0 || b == 0 ? 0 : a * b;
  if (code == Code::either) return a == 1 || b == 1 ? 1 : a + b;
  if (std::isnan(a) || std::isnan(b)) return kUnknown;
  switch (code) {
    case Code::add:
      return finite(a + b);
    case Code::subtract:
      return finite(a - b);
    case Code::multiply:
      return finite(a * b);
    case Code::divide:
      return finite(a / b);
    case Code::smaller:
      return std::min(a, b);
    case Code::larger:
      return std::max(a, b);
    case Code::less:
      return truth(a < b);
    case Code::less_equal:
      return truth(a <= b);
    case Code::greater:
      return truth(a > b);
    case Code::greater_equal:
      return truth(a >= b);
    case Code::equal:
      return truth(a == b);
    case Code::unequal:
      return truth(a != b);
    default:
      return kUnknown;
  }
}

/// The text, a mark below the character, the rule.
std::string text_of(std::string_view text, const std::vector<Problem>& problems) {
  std::string all;
  for (const auto& problem : problems) {
    const auto column =
        std::count_if(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(problem.position),
                      [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
    all += (all.empty() ? "" : "\n") + std::string{text} + '\n' +
           std::string(static_cast<std::size_t>(column), ' ') + "^ character " + std::to_string(column + 1) +
           ": " + problem.what;
  }
  return all;
}

}  // namespace

Error::Error(std::string_view text, std::vector<Problem> problems)
    : std::runtime_error(text_of(text, problems)), problems_{std::move(problems)} {}

Expression::Expression(std::string_view text, const Vocabulary& vocabulary) : text_{text} {
  auto program = parse(text, vocabulary);
  type_ = std::move(program.result.type);
  steps_ = std::move(program.steps);
  risings_ = program.risings;
}

Memory Expression::memory() const {
  return {.previous = std::vector<double>(risings_, kUnknown), .stack = std::vector<double>(steps_.size())};
}

double Expression::evaluate(std::span<const double> row, Memory& memory) const {
  auto& stack = memory.stack;
  std::size_t top = 0;  // number of values on the stack
  for (const Step& step : steps_) switch (step.code) {
      case Code::number:
        stack[top++] = step.value;
        break;
      case Code::column:
        stack[top++] = row[step.index] * step.value;
        break;
      case Code::negate:
        stack[top - 1] = -stack[top - 1];
        break;
      case Code::absolute:
        stack[top - 1] = std::abs(stack[top - 1]);
        break;
      case Code::invert:
        stack[top - 1] = 1 - stack[top - 1];
        break;
      case Code::rising:
        stack[top - 1] = risen(stack[top - 1], memory.previous[step.index]);
        break;
      default:
        --top;
        stack[top - 1] = combined(step.code, stack[top - 1], stack[top]);
    }
  return stack[0];
}

Expression condition(std::string_view text, const Vocabulary& vocabulary) {
  Expression expression{text, vocabulary};
  if (const auto problem = no_condition({.type = expression.type()}, "a trigger"))
    throw Error(text, {{0, *problem}});
  return expression;
}

}  // namespace crane::expression
