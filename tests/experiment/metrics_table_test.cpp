#include <gmock/gmock.h>

#include <numbers>
#include <sstream>

#include "crane/experiment/metrics.hpp"

namespace crane::experiment {
namespace {

std::vector<NamedMetrics> two_runs() {
  Metrics settled;
  settled.settling_time_s = 3.384;
  settled.overshoot_percent[0] = 0;
  settled.deviation[1] = 2 * std::numbers::pi / 180;
  settled.largest_swing_radial_rad = 5.6 * std::numbers::pi / 180;
  settled.largest_v = {2.9, 10, 0};
  Metrics not_settled = settled;
  not_settled.settling_time_s.reset();
  not_settled.overshoot_percent = {std::nullopt, 12.34, std::nullopt};
  not_settled.deviation = {0.174, std::nullopt, 0};
  return {{"maneuver_1", "gain_scheduling_partial", settled}, {"maneuver_2", "none", not_settled}};
}

std::string printed(TableStyle style) {
  std::ostringstream out;
  print_table(out, two_runs(), style);
  return out.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in{text};
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(MetricsTable, ShowsPercentForMovedAxesAndTheDeviationOfTheOthers) {
  const auto lines = lines_of(printed(TableStyle::text));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_THAT(lines[2],
              testing::ContainsRegex("maneuver_1 +gain_scheduling_partial +3.38 +0.0 % +2.0 deg +5.6 "));
  EXPECT_THAT(lines[3], testing::ContainsRegex("maneuver_2 +none +- +17.4 cm +12.3 % +5.6 "));
}

TEST(MetricsTable, AlignsEveryLine) {
  for (const TableStyle style : {TableStyle::text, TableStyle::markdown}) {
    const auto lines = lines_of(printed(style));
    for (const std::string& line : lines) EXPECT_EQ(line.size(), lines.front().size());
  }
}

TEST(MetricsTable, IsMarkdownWhenAsked) {
  const auto lines = lines_of(printed(TableStyle::markdown));
  EXPECT_THAT(lines[0], testing::StartsWith("| scenario"));
  EXPECT_THAT(lines[1], testing::MatchesRegex("\\| -+ \\| -+ (\\| -+: )+\\|"));
}

}  // namespace
}  // namespace crane::experiment
