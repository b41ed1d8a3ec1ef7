/// Texts that a generator of triggers or an attacker could write. Each text is either an expression or is
/// refused with a short message.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vocabulary.hpp"

namespace crane::expression {
namespace {

constexpr std::size_t kMegabyte = 1'000'000, kLongestMessage = 300'000;

std::string repeated(std::string_view part, std::size_t bytes) {
  std::string text;
  while (text.size() < bytes) text += part;
  return text;
}

/// @return length of the refusal; 0: the text is an expression, and it was evaluated
std::size_t refusal_of(const std::string& text) {
  try {
    const Expression expression{text, vocabulary()};
    auto memory = expression.memory();
    (void)expression.evaluate(std::vector<double>{0.5, -2.0, 0.1, 300.0, 1.0, 1.0}, memory);
    return 0;
  } catch (const Error& error) {
    return std::string_view{error.what()}.size();
  }
}

TEST(HostileText, OfAMegabyteIsRefusedWithAShortMessage) {
  for (const char* part : {"(", "not ", "-", "abs(", "rising(", "x_m + ", "$", "\xff", "1 ", "1 furlong + ",
                           "nobody + ", "9", "x", "min(1,", "a.b[", "x_m or ", "\n", "1 < "}) {
    const auto length = refusal_of(repeated(part, kMegabyte));
    EXPECT_GT(length, 0U) << part;
    EXPECT_LT(length, 1000U) << part;
  }
}

TEST(HostileText, OfTheLargestLengthHasABoundedMessage) {
  for (const char* part : {"(", "not ", "-", "$", "\xff", "1 furlong + ", "nobody + ", "x_m or ", "1 < "}) {
    const auto length = refusal_of(repeated(part, kLongestText - 20));
    EXPECT_GT(length, 0U) << part;
    EXPECT_LT(length, kLongestMessage) << part;
  }
}

TEST(HostileText, OfTheLargestLengthCanBeAnExpression) {
  EXPECT_EQ(refusal_of(repeated("1 + ", kLongestText - 20) + "1"), 0U);
}

TEST(HostileText, CannotLoseAUnitByLargeExponents) {
  const auto power = [](const char* sign, int n) { return repeated(sign, static_cast<std::size_t>(n) * 6); };
  EXPECT_GT(refusal_of("1" + power(" * x_m", 150) + power(" / x_m", 100) + " > 1"), 0U)
      << "m^50 is no number without unit";
  EXPECT_EQ(refusal_of("1" + power(" * x_m", 12) + power(" / x_m", 12) + " > 1"), 0U);
}

TEST(HostileText, WithADivisionByZeroOrAnOverflowIsUnknown) {
  for (const char* text :
       {"1 / 0 > 5", "-1 / 0 < 5", "0 / 0 == 0", "x_m / (x_m - x_m) > 0", "1e308 * 1e308 > 0",
        "-1e308 - 1e308 < 0", "abs(1 / 0) > 5", "max(1 / 0, 2) > 1", "not 1 / 0 > 5"}) {
    const Expression expression{text, vocabulary()};
    auto memory = expression.memory();
    EXPECT_TRUE(std::isnan(expression.evaluate(std::vector<double>(6, 0.5), memory))) << text;
  }
}

TEST(HostileText, OfRandomBytesOrTokensIsRefusedOrEvaluated) {
  constexpr unsigned kSeed = 20031;
  constexpr std::array kTokens{"(",   ")",   "x_m", "y_m",    "open", "phase", "BUSY", "and",  "or", "not",
                               "abs", "min", "max", "rising", ",",    "<",     ">=",   "==",   "!=", "+",
                               "-",   "*",   "/",   "1",      "2.5m", "3 deg", "1e9",  "1e-9", ".",  "="};
  std::mt19937 random{kSeed};
  const auto draw = [&](std::size_t n) { return random() % n; };
  int expressions = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::string text;
    for (std::size_t n = draw(12) + 1; n > 0; --n)
      text += i % 4 == 0 ? std::string(1, static_cast<char>(draw(256)))
                         : std::string{kTokens[draw(kTokens.size())]} + ' ';
    if (refusal_of(text) == 0) ++expressions;
  }
  EXPECT_GT(expressions, 1000) << "the seed " << kSeed << " must also generate expressions";
}

}  // namespace
}  // namespace crane::expression
