/// Lines of a swing, and the two cables that have them as natural frequencies.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "crane/diagnosis/candidate.hpp"
#include "study/swing_lines.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kGravity = 9.81;

PreparedRun swinging(const std::vector<std::pair<double, double>>& hz_and_rad) {
  PreparedRun run;
  run.run.period_s = 0.01;
  for (int k = 0; k < 3000; ++k) {
    double sum = 0;
    for (const auto& [hz, rad] : hz_and_rad) sum += rad * std::sin(kTurn * hz * 0.01 * k + hz);
    run.run.command_v.emplace_back();
    run.run.measured[kRadialSwing].push_back(sum);
    run.on_grid[kRadialSwing].push_back(sum);
  }
  return run;
}

TEST(SwingLines, AreThoseOfTheSwingInOrderOfStrength) {
  const auto lines = swing_lines({swinging({{0.9, 0.1}, {2.03, 0.01}, {3.4, 0.03}})}, 3);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_NEAR(lines[0], 0.9, 0.02);
  EXPECT_NEAR(lines[1], 3.4, 0.02);
  EXPECT_NEAR(lines[2], 2.03, 0.02);
}

TEST(SwingLines, AreNotTheSkirtsOfAStrongLine) {
  const auto lines = swing_lines({swinging({{1, 0.1}, {2.5, 0.002}})}, 2);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_NEAR(lines[1], 2.5, 0.02);
}

TEST(SwingLines, AreNoneWithoutASwing) {
  PreparedRun run;
  run.run.period_s = 0.01;
  run.run.command_v.resize(1000);
  EXPECT_TRUE(swing_lines({run}, 3).empty());
  EXPECT_TRUE(swing_lines({}, 3).empty());
}

/// Textbook: w^2 = g / (2 m1) (b -+ sqrt(b^2 - 4 m1 m / (a l))), b = m (1 / a + 1 / l), m = m1 + m2.
TEST(TwoCables, HaveBothNaturalFrequencies) {
  for (const double share : {0.1, 0.5, 0.95})
    for (const TwoCables& c : cables_with(0.9, 2.03, share, kGravity)) {
      const double m1 = 1 - c.lower_share, b = 1 / c.upper_m + 1 / c.lower_m;
      const double root = std::sqrt(b * b - 4 * m1 / (c.upper_m * c.lower_m));
      EXPECT_NEAR(std::sqrt(kGravity / (2 * m1) * (b - root)) / kTurn, 0.9, 1e-9);
      EXPECT_NEAR(std::sqrt(kGravity / (2 * m1) * (b + root)) / kTurn, 2.03, 1e-9);
    }
}

TEST(TwoCables, AreTheTwoOrdersOfOnePair) {
  const auto [longer_below, longer_above] = cables_with(0.8, 2.2, 0.6, kGravity);
  EXPECT_GT(longer_below.lower_m, longer_below.upper_m);
  EXPECT_DOUBLE_EQ(longer_below.lower_m, longer_above.upper_m);
  EXPECT_DOUBLE_EQ(longer_below.upper_m, longer_above.lower_m);
}

TEST(TwoCables, AreOfOneLengthAtTheLargestShare) {
  const auto [a, b] = cables_with(0.8, 2.2, 1, kGravity);
  EXPECT_NEAR(a.lower_m, a.upper_m, 1e-7);
  EXPECT_NEAR(b.lower_m, b.upper_m, 1e-7);
}

/// For two measured frequencies, the lower mass or the lower length may be outside the bounds of the term.
TEST(TwoCables, BeginWithinTheBoundsOfTheirParametersForAnyTwoFrequencies) {
  const auto rig = configuration::load_rig(CRANE_RIGS "/gantry.toml");
  std::size_t starts = 0;
  for (const double slow : {0.2, 0.4, 0.8})
    for (const double fast : {0.5, 1.0, 2.0, 4.0, 8.0}) {
      const auto candidates = candidates_for(rig, {swinging({{slow, 0.1}, {fast, 0.05}})});
      for (const Candidate& candidate : candidates)
        for (const auto& values : candidate.ringing_starts) {
          ++starts;
          EXPECT_TRUE(candidate.permits(values))
              << candidate.label() << ", " << slow << " and " << fast << " Hz";
        }
    }
  EXPECT_GT(starts, 20U);
}

}  // namespace
}  // namespace crane::diagnosis
