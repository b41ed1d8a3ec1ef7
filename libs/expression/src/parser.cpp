#include "parser.hpp"

#include <algorithm>
#include <array>

#include "crane/fields/nearest_name.hpp"

namespace crane::expression {
namespace {

using Code = Expression::Code;

/// Ends the parse, because the structure of the rest of the text is unknown.
struct Stop {};

struct Operator {
  std::string_view sign;
  Code code;
};
constexpr std::array<Operator, 6> kComparisons{{{"<", Code::less},
                                                {"<=", Code::less_equal},
                                                {">", Code::greater},
                                                {">=", Code::greater_equal},
                                                {"==", Code::equal},
                                                {"!=", Code::unequal}}};
constexpr std::array<std::string_view, 4> kFunctions{"abs", "min", "max", "rising"};
constexpr std::size_t kDeepest = 64;  // nested parentheses; each level needs stack
constexpr std::size_t kShownOfLongText = 60;

class Parser {
 public:
  Parser(std::string_view text, const Vocabulary& vocabulary) : text_{text}, vocabulary_{vocabulary} {}

  Program run() {
    if (text_.size() > kLongestText)
      throw Error(text_.substr(0, kShownOfLongText),
                  {{0, "the expression has " + std::to_string(text_.size()) + " bytes, more than " +
                           std::to_string(kLongestText)}});
    tokens_ = tokens_of(text_, problems_);
    try {
      program_.result = disjunction();
      if (peek().kind != Token::Kind::end) fail("expected an operator or the end, found " + found());
    } catch (const Stop&) {
    }
    problems_.resize(std::min(problems_.size(), kMostProblems));
    if (!problems_.empty()) throw Error(text_, std::move(problems_));
    return std::move(program_);
  }

 private:
  [[nodiscard]] const Token& peek() const { return tokens_[at_]; }
  [[nodiscard]] std::string found() const {
    return peek().kind == Token::Kind::end ? "the end" : "'" + std::string{peek().text} + "'";
  }
  [[nodiscard]] bool is(std::string_view text) const {
    return peek().kind != Token::Kind::number && peek().text == text;
  }
  bool accept(std::string_view text) {
    if (!is(text)) return false;
    ++at_;
    return true;
  }
  void expect(std::string_view text) {
    if (!accept(text)) fail("expected '" + std::string{text} + "', found " + found());
  }
  [[noreturn]] void fail(const std::string& what) {
    problems_.push_back({peek().position, what});
    throw Stop{};
  }
  /// @return true when there is a problem, which is then reported
  bool report(std::size_t position, const std::optional<std::string>& problem) {
    if (problem) problems_.push_back({position, *problem});
    return problem.has_value();
  }
  void emit(Code code, double value = 0, std::size_t index = 0) {
    program_.steps.push_back({code, value, index});
  }
  static Operand condition_operand(bool unknown = false) {
    return {.type = {.kind = Type::Kind::condition}, .unknown = unknown};
  }

  Operand connected(std::string_view word, Code code, Operand (Parser::*part)()) {
    const auto begin = peek().position;
    Operand left = (this->*part)();
    while (is(word)) {
      const auto position = peek().position;
      ++at_;
      const auto right_position = peek().position;
      const Operand right = (this->*part)();
      const std::string of = "'" + std::string{word} + "' (character " + std::to_string(position + 1) + ")";
      report(begin, no_condition(left, of));
      report(right_position, no_condition(right, of));
      emit(code);
      left = condition_operand();
    }
    return left;
  }
  Operand disjunction() { return connected("or", Code::either, &Parser::conjunction); }
  Operand conjunction() { return connected("and", Code::both, &Parser::inversion); }

  Operand inversion() {
    if (!is("not")) return comparison();
    if (++depth_ > kDeepest) fail("nested deeper than " + std::to_string(kDeepest));
    ++at_;
    const auto position = peek().position;
    const Operand operand = inversion();
    --depth_;
    const bool wrong = report(position, no_condition(operand, "'not'"));
    emit(Code::invert);
    return condition_operand(wrong);
  }

  [[nodiscard]] const Operator* comparison_here() const {
    const auto* const known =
        std::ranges::find_if(kComparisons, [this](const Operator& o) { return is(o.sign); });
    return known == kComparisons.end() ? nullptr : known;
  }

  Operand comparison() {
    Operand left = sum();
    const auto* const chosen = comparison_here();
    if (chosen == nullptr) return left;
    const auto position = peek().position;
    ++at_;
    const Operand right = sum();
    const bool equality = chosen->code == Code::equal || chosen->code == Code::unequal;
    const std::string of = "'" + std::string{chosen->sign} + "'";
    const bool wrong = report(position, unequal_quantities(left, right, of)) ||
                       (!equality && report(position, no_quantity(left, of)));
    emit(chosen->code);
    if (comparison_here() != nullptr) fail("comparisons cannot be chained; write a < b and b < c");
    return condition_operand(wrong);
  }

  Operand sum() {
    Operand left = product();
    while (is("+") || is("-")) {
      const auto sign = peek();
      ++at_;
      const Operand right = product();
      const std::string of = "'" + std::string{sign.text} + "'";
      const bool wrong = report(sign.position, unequal_quantities(left, right, of)) ||
                         report(sign.position, no_quantity(left, of));
      emit(sign.text == "+" ? Code::add : Code::subtract);
      left = {.type = left.bare ? right.type : left.type,
              .bare = left.bare && right.bare,
              .unknown = wrong || left.unknown || right.unknown};
    }
    return left;
  }

  Operand product() {
    Operand left = unary();
    while (is("*") || is("/")) {
      const auto sign = peek();
      ++at_;
      const Operand right = unary();
      const std::string of = "'" + std::string{sign.text} + "'";
      const bool times = sign.text == "*";
      const auto dimension =
          times ? left.type.dimension * right.type.dimension : left.type.dimension / right.type.dimension;
      const bool wrong = report(sign.position, no_quantity(left, of)) ||
                         report(sign.position, no_quantity(right, of)) ||
                         report(sign.position, no_dimension(dimension, of));
      emit(times ? Code::multiply : Code::divide);
      left = {.type = {.dimension = dimension},
              .bare = left.bare && right.bare,
              .unknown = wrong || left.unknown || right.unknown};
    }
    return left;
  }

  Operand unary() {
    if (!is("-")) return primary();
    if (++depth_ > kDeepest) fail("nested deeper than " + std::to_string(kDeepest));
    const auto position = peek().position;
    ++at_;
    Operand operand = unary();
    --depth_;
    operand.unknown = report(position, no_quantity(operand, "'-'")) || operand.unknown;
    emit(Code::negate);
    return operand;
  }

  Operand primary() {
    const Token token = peek();
    if (token.kind == Token::Kind::number) {
      ++at_;
      emit(Code::number, token.value);
      if (token.unit == nullptr) return {.bare = true};
      return {.type = {.dimension = token.unit->dimension}};
    }
    if (is("(")) {
      if (++depth_ > kDeepest) fail("nested deeper than " + std::to_string(kDeepest));
      ++at_;
      Operand inner = disjunction();
      expect(")");
      --depth_;
      return inner;
    }
    if (token.kind != Token::Kind::name || is("and") || is("or") || is("not"))
      fail("expected a name, a number or '(', found " + found());
    ++at_;
    return is("(") ? call(token) : name(token);
  }

  Operand name(const Token& token) {
    const auto symbol = vocabulary_.find(token.text);
    if (!symbol) {
      problems_.push_back({token.position, vocabulary_.explain(token.text)});
      return {.unknown = true};
    }
    if (symbol->constant)
      emit(Code::number, symbol->value);
    else
      emit(Code::column, symbol->factor, symbol->column);
    return {.type = symbol->type};
  }

  Operand call(const Token& function) {
    if (std::ranges::find(kFunctions, function.text) == kFunctions.end()) {
      const auto meant = fields::nearest_name(function.text, kFunctions);
      problems_.push_back({function.position, "unknown function '" + std::string{function.text} + "'; " +
                                                  (meant.empty() ? "" : "did you mean " + meant + "? ") +
                                                  "The functions are abs, min, max, rising"});
      throw Stop{};
    }
    if (++depth_ > kDeepest) fail("nested deeper than " + std::to_string(kDeepest));
    expect("(");
    const auto position = peek().position;
    const Operand first = disjunction();
    const std::string of = std::string{function.text} + "()";
    Operand result = function.text == "rising" ? rising(first, position)
                     : function.text == "abs"  ? absolute(first, position)
                                               : extreme(function, first, position);
    if (is(",")) fail(of + " has one argument");
    expect(")");
    --depth_;
    return result;
  }

  Operand rising(const Operand& argument, std::size_t position) {
    const bool wrong = report(position, no_condition(argument, "rising()"));
    emit(Code::rising, 0, program_.risings++);
    return condition_operand(wrong);
  }

  Operand absolute(Operand argument, std::size_t position) {
    argument.unknown = report(position, no_quantity(argument, "abs()")) || argument.unknown;
    emit(Code::absolute);
    return argument;
  }

  /// min() or max() of two or more quantities.
  Operand extreme(const Token& function, Operand result, std::size_t position) {
    const std::string of = std::string{function.text} + "()";
    result.unknown = report(position, no_quantity(result, of)) || result.unknown;
    if (!is(",")) fail(of + " needs two or more arguments");
    while (accept(",")) {
      const auto at = peek().position;
      const Operand next = disjunction();
      const bool wrong = report(at, unequal_quantities(result, next, of));
      emit(function.text == "min" ? Code::smaller : Code::larger);
      result = {.type = result.bare ? next.type : result.type,
                .bare = result.bare && next.bare,
                .unknown = wrong || result.unknown || next.unknown};
    }
    return result;
  }

  std::string_view text_;
  const Vocabulary& vocabulary_;
  std::vector<Problem> problems_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0, depth_ = 0;
  Program program_;
};

}  // namespace

Program parse(std::string_view text, const Vocabulary& vocabulary) { return Parser{text, vocabulary}.run(); }

}  // namespace crane::expression
