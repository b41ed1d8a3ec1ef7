/// Bad expressions: position and rule of every problem.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "vocabulary.hpp"

namespace crane::expression {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

std::vector<Problem> problems_of(std::string_view text) {
  try {
    (void)condition(text, vocabulary());
  } catch (const Error& error) {
    return error.problems();
  }
  return {};
}

auto problem(std::size_t position, const std::string& what) {
  return testing::AllOf(Field(&Problem::position, position), Field(&Problem::what, HasSubstr(what)));
}

TEST(ExpressionProblems, NameTheCharacterAndTheRule) {
  struct Case {
    std::string text;
    std::size_t position;
    std::string what;
  };
  const std::vector<Case> cases{
      {"", 0, "expected a name, a number or '(', found the end"},
      {"x_m >", 5, "expected a name, a number or '(', found the end"},
      {"(x_m > 1m", 9, "expected ')', found the end"},
      {"x_m > 1m)", 8, "expected an operator or the end, found ')'"},
      {"x_m > 1m y_m", 9, "expected an operator or the end, found 'y_m'"},
      {"x_m > and", 6, "expected a name, a number or '(', found 'and'"},
      {"x_m > 5deg", 4,
       "both sides of '>' must be the same quantity, found a quantity in m and a quantity in rad; units of "
       "the "
       "left side: m, cm, mm"},
      {"x_m + angle_rad > 1", 4, "both sides of '+'"},
      {"x_m > 1 furlong", 8, "unknown unit 'furlong'; the units are m, cm, mm, rad"},
      {"abs(x_m)", 0, "a trigger needs a condition, such as a comparison, found a quantity in m"},
      {"x_m and open", 0, "'and' (character 5) needs a condition"},
      {"open and x_m", 9, "'and' (character 6) needs a condition"},
      {"not x_m", 4, "'not' needs a condition"},
      {"rising(x_m)", 7, "rising() needs a condition"},
      {"open > 1", 5, "both sides of '>'"},
      {"open > open", 5, "'>' needs a quantity, found a condition"},
      {"phase == open", 6, "found a value of Phase and a condition"},
      {"phase == 1", 6, "found a value of Phase and a number without unit"},
      {"abs(x_m, y_m) > 1", 7, "abs() has one argument"},
      {"min(x_m) > 1", 7, "min() needs two or more arguments"},
      {"sqrt(x_m) > 1", 0, "unknown function 'sqrt'; The functions are abs, min, max, rising"},
      {"ads(x_m) > 1", 0, "unknown function 'ads'; did you mean abs?"},
      {"1m < x_m < 2m", 9, "comparisons cannot be chained; write a < b and b < c"},
      {"x_m = 1m", 4, "'=' has no meaning here; a comparison is written =="},
      {"open & open", 5, "'&' has no meaning here; write and"},
      {"x_m > 1e999", 6, "the number is out of range"},
  };
  for (const auto& one : cases)
    EXPECT_THAT(problems_of(one.text), testing::Contains(problem(one.position, one.what))) << one.text;
}

TEST(ExpressionProblems, AreReportedTogether) {
  EXPECT_THAT(problems_of("x > 1 and y_m > 2 rad or z < 3"),
              ElementsAre(problem(0, "unknown name 'x'"), problem(14, "both sides of '>'"),
                          problem(25, "unknown name 'z'")));
}

TEST(ExpressionProblems, AreMarkedBelowTheText) {
  EXPECT_THAT([] { (void)condition("open or x_ > 1", vocabulary()); },
              testing::ThrowsMessage<Error>("open or x_ > 1\n        ^ character 9: unknown name 'x_'"));
  EXPECT_THAT(
      [] { (void)condition("open and ä x_", vocabulary()); },
      testing::ThrowsMessage<Error>(HasSubstr("open and ä x_\n           ^ character 12: unknown name 'x_'")))
      << "a character beyond ASCII is one column";
}

TEST(ExpressionProblems, DeepNestingIsRefused) {
  for (const char* part : {"(", "not ", "-", "abs("}) {
    std::string text;
    while (text.size() < kLongestText - 4) text += part;
    EXPECT_THAT(problems_of(text), ElementsAre(Field(&Problem::what, HasSubstr("nested deeper than 64"))))
        << part;
  }
}

TEST(ExpressionProblems, RandomTextIsAnExpressionOrHasProblemsWithinTheText) {
  constexpr unsigned kSeed = 20031;
  const std::vector<std::string> parts{"x_m", "open", "phase", "BUSY", " and ",   " or ", "not ",  "(",
                                       ")",   ",",    "abs(",  "min(", "rising(", "5deg", "1 m/s", "3",
                                       "<",   ">=",   "==",    "+",    "-",       "*",    "/",     "=",
                                       "$",   "ä",    " ",     ".",    "["};
  std::mt19937 random{kSeed};
  int accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string text;
    for (auto n = random() % 8 + 1; n > 0; --n) text += parts[random() % parts.size()];
    try {
      const auto expression = condition(text, vocabulary());
      auto memory = expression.memory();
      (void)expression.evaluate(std::vector<double>(6, 0.0), memory);
      ++accepted;
    } catch (const Error& error) {
      ASSERT_FALSE(error.problems().empty()) << "seed " << kSeed << ": " << text;
      for (const auto& one : error.problems()) ASSERT_LE(one.position, text.size()) << text;
    }
  }
  EXPECT_GT(accepted, 100) << "seed " << kSeed;
}

}  // namespace
}  // namespace crane::expression
