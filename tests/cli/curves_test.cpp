/// Curves of braille characters, compared with pictures drawn by hand.
#include "cli/curves.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "cli/terminal.hpp"

namespace crane::cli {
namespace {

using testing::HasSubstr;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Curve, RampGoesFromTheLowerLeftToTheUpperRight) {
  // 4 x 4 points: (0,3), (1,2), (2,1), (3,0)
  const std::vector<double> time_s{0, 1, 2, 3}, values{0, 1, 2, 3};
  EXPECT_EQ(draw_curve(time_s, values, {.columns = 2, .rows = 1, .from_s = 0, .to_s = 3}), "        3 ┤⡠⠊\n");
}

TEST(Curve, HasTheExtremesAsLabels) {
  const std::vector<double> time_s{0, 1}, values{-2.5, 7};
  const auto text = draw_curve(time_s, values, {.columns = 10, .rows = 3, .from_s = 0, .to_s = 1});
  EXPECT_THAT(text, testing::StartsWith("        7 ┤"));
  EXPECT_THAT(text, HasSubstr("\n     -2.5 ┤"));
}

TEST(Curve, PeakOfOneSampleAmongThousandsIsVisible) {
  std::vector<double> time_s, values;
  for (int i = 0; i < 5000; ++i) {
    time_s.push_back(i * 0.01);
    values.push_back(i == 2500 ? 1 : 0);
  }
  const auto text = draw_curve(time_s, values, {.columns = 20, .rows = 3, .from_s = 0, .to_s = 49.99});
  const auto first_line = text.substr(0, text.find('\n'));
  EXPECT_NE(first_line.find_first_not_of(" 1┤", 0), std::string::npos) << text;
}

TEST(Curve, MissingValuesInterruptIt) {
  // A constant lies in the middle, 1.5 points below the highest: rounded to point 1.
  const std::vector<double> time_s{0, 1, 2, 3}, values{0, kNaN, kNaN, 0};
  EXPECT_EQ(draw_curve(time_s, values, {.columns = 2, .rows = 1, .from_s = 0, .to_s = 3}), "        1 ┤⠂⠐\n");
  const std::vector<double> none{kNaN, kNaN, kNaN, kNaN};
  EXPECT_EQ(draw_curve(time_s, none, {.columns = 2, .rows = 1, .from_s = 0, .to_s = 3}), "        1 ┤  \n");
  EXPECT_FALSE(extent_of(none));
}

TEST(Curve, MarkIsAVerticalLineBehindTheCurve) {
  const std::vector<double> time_s{-1, 1}, values{0, 0};
  const auto text =
      draw_curve(time_s, values, {.columns = 5, .rows = 3, .from_s = -1, .to_s = 1, .mark_s = 0});
  EXPECT_THAT(text, testing::StartsWith("        1 ┤  ┊  \n          │⠒⠒⠒⠒⠒\n"));
  EXPECT_THAT(draw_time_axis({.columns = 5, .rows = 3, .from_s = -1, .to_s = 1, .mark_s = 0}),
              HasSubstr("└┬─▲─┬"));
}

TEST(Curve, EveryLineIsAsWideAsTheBox) {
  const std::vector<double> time_s{0, 1, 2}, values{1e6, -1e-9, 12345.678};
  const CurveBox box{.columns = 33, .rows = 5, .from_s = 0, .to_s = 2, .mark_s = 1};
  std::istringstream lines{draw_curve(time_s, values, box)};
  for (std::string line; std::getline(lines, line);)
    EXPECT_EQ(width_of(line), static_cast<std::size_t>(kLabelColumns + 33)) << line;
}

TEST(TimeAxis, LabelsBothEnds) {
  const auto text = draw_time_axis({.columns = 60, .rows = 3, .from_s = -1, .to_s = 2, .mark_s = 0});
  EXPECT_THAT(text, HasSubstr("-1.00 s"));
  EXPECT_THAT(text, HasSubstr("2.00 s\n"));
}

}  // namespace
}  // namespace crane::cli
