#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <random>

#include "crane/report/page.hpp"
#include "plots_of.hpp"

namespace crane::report {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Series series_of(std::vector<double> y, Style style = Style::line) {
  return {.name = "s", .x = {}, .y = std::move(y), .style = style, .upper = {}};
}

LinePlot plot_of(std::vector<double> x, std::vector<Series> series) {
  return {.title = "p",
          .x_label = "",
          .y_label = "",
          .x = std::move(x),
          .series = std::move(series),
          .group = ""};
}

nlohmann::json shown(const LinePlot& plot) {
  return plots_of(to_html({.title = "", .summary = "", .sections = {{"", {plot}}}})).at(0);
}

std::string refusal_of(const LinePlot& plot) {
  try {
    (void)shown(plot);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(PlotData, KeepsValuesToFiveDigitsOfTheirRange) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> unit{-1, 1}, power{-12, 12};
  for (int trial = 0; trial < 200; ++trial) {
    const double scale = std::pow(10.0, power(random)), offset = unit(random) * std::pow(10.0, power(random));
    std::vector<double> x, y;
    for (int i = 0; i < 50; ++i) {
      x.push_back(i);
      y.push_back(offset + scale * unit(random));
    }
    const auto [low, high] = std::minmax_element(y.begin(), y.end());
    // Tolerance: half a step of 1e-5 of the range, plus the error of 15 digits of a double.
    const double tolerance = 0.5e-5 * (*high - *low) + 1e-14 * std::max(std::abs(*low), std::abs(*high));
    EXPECT_THAT(decoded(shown(plot_of(x, {series_of(y)})).at("series")[0].at("y")),
                testing::Pointwise(testing::DoubleNear(tolerance), y));
  }
}

TEST(PlotData, LeavesGapsWhereValuesAreNotFinite) {
  const auto y =
      decoded(shown(plot_of({0, 1, 2, 3}, {series_of({1, kNaN, std::numeric_limits<double>::infinity(), 2})}))
                  .at("series")[0]
                  .at("y"));
  EXPECT_THAT(y, ElementsAre(1, testing::IsNan(), testing::IsNan(), 2));
}

TEST(PlotData, EncodesConstantsAndEmptyData) {
  EXPECT_THAT(decoded(shown(plot_of({0, 1}, {series_of({0, 0})})).at("series")[0].at("y")),
              ElementsAre(0, 0));
  EXPECT_THAT(decoded(shown(plot_of({0, 1}, {series_of({-7.5, -7.5})})).at("series")[0].at("y")),
              ElementsAre(testing::DoubleEq(-7.5), testing::DoubleEq(-7.5)));
  EXPECT_THAT(decoded(shown(plot_of({}, {series_of({})})).at("series")[0].at("y")), ElementsAre());
}

TEST(PlotData, PutsPointsInOrder) {
  const auto plot = shown(plot_of({3, 1, 2, 1}, {series_of({30, 10, 20, 11}, Style::points)}));
  EXPECT_THAT(decoded(plot.at("xs")[0]), testing::Pointwise(testing::DoubleNear(1e-5), {1, 1, 2, 3}));
  EXPECT_THAT(decoded(plot.at("series")[0].at("y")),
              testing::Pointwise(testing::DoubleNear(2e-4), {10, 11, 20, 30}));
}

TEST(PlotData, ContainsEveryDistinctXOnce) {
  Series own = series_of({1, 2, 3});
  own.x = {0, 5, 10};
  const auto plot = shown(plot_of({0, 1}, {series_of({1, 2}), own, series_of({3, 4})}));
  EXPECT_EQ(plot.at("xs").size(), 2U);
  EXPECT_EQ(plot.at("series")[0].at("x"), 0);
  EXPECT_EQ(plot.at("series")[1].at("x"), 1);
  EXPECT_EQ(plot.at("series")[2].at("x"), 0);
}

TEST(PlotData, RefusesInvalidDataWithPlotAndSeries) {
  EXPECT_EQ(refusal_of(plot_of({0, 1}, {series_of({1})})), "plot \"p\", series \"s\": 1 y for 2 x");
  EXPECT_THAT(refusal_of(plot_of({1, 0}, {series_of({1, 2})})), HasSubstr("x decreases"));
  EXPECT_THAT(refusal_of(plot_of({0, kNaN}, {series_of({1, 2}, Style::points)})),
              HasSubstr("x is not finite"));
  EXPECT_THAT(refusal_of(plot_of({0, 1}, {series_of({1, 2}, Style::band)})), HasSubstr("band"));
  Series line = series_of({1, 2});
  line.upper = {3, 4};
  EXPECT_THAT(refusal_of(plot_of({0, 1}, {line})), HasSubstr("band"));
}

}  // namespace
}  // namespace crane::report
