#include "crane/control/fuzzy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace crane::control {
namespace {

// Index of a label in the tables.
constexpr std::size_t kNM = 1, kNS = 2, kZO = 3, kPS = 4, kPB = 6;

TEST(FuzzyRules, AnswerWithTheirOwnLabelAtEveryCentre) {
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      EXPECT_NEAR(fuzzy_output(kPrintedRules, i / 3.0, j / 3.0),
                  kPrintedRules[static_cast<std::size_t>(i + 3)][static_cast<std::size_t>(j + 3)] / 3.0,
                  1e-12);
}

TEST(FuzzyRules, WeighTheFourRulesThatFireByTheProductOfTheirDegrees) {
  // x1 = 0.2 is 0.4 ZO, 0.6 PS; x2 = -0.6 is 0.8 NM, 0.2 NS, as in the text.
  const auto& r = kPrintedRules;
  const double expected =
      (0.4 * (0.8 * r[kZO][kNM] + 0.2 * r[kZO][kNS]) + 0.6 * (0.8 * r[kPS][kNM] + 0.2 * r[kPS][kNS])) / 3;
  EXPECT_NEAR(fuzzy_output(r, 0.2, -0.6), expected, 1e-12);
}

TEST(FuzzyRules, CountInputsBeyondTheLastLabelAsTheLastLabel) {
  EXPECT_EQ(fuzzy_output(kPrintedRules, 7, -1e300), fuzzy_output(kPrintedRules, 1, -1));
  EXPECT_TRUE(std::isnan(fuzzy_output(kPrintedRules, NAN, 0)));
}

TEST(GeneratedRules, HaveTheDegreesOfTheWorkedExample) {
  const auto generated = rules_from({{0.2, -0.6, 0.9}});
  for (const std::size_t row : {kZO, kPS})
    for (const std::size_t column : {kNM, kNS}) EXPECT_EQ(generated.rules[row][column], 3);
  EXPECT_NEAR(generated.degrees[kZO][kNM], 0.224, 1e-12);  // (3.52) and Table 3.6
  EXPECT_NEAR(generated.degrees[kZO][kNS], 0.056, 1e-12);
  EXPECT_NEAR(generated.degrees[kPS][kNM], 0.336, 1e-12);
  EXPECT_NEAR(generated.degrees[kPS][kNS], 0.084, 1e-12);
  EXPECT_EQ(generated.degrees[kPB][kPB], 0);
}

TEST(GeneratedRules, KeepTheRuleWithTheLargestDegreeOfConflictingOnes) {
  const auto generated = rules_from({{0.1, 0, 1}, {0, 0, 0.3}, {0.2, 0, -1}});
  EXPECT_EQ(generated.rules[kZO][kZO], 1);
  EXPECT_NEAR(generated.degrees[kZO][kZO], 0.9, 1e-12);
}

TEST(GeneratedRules, FillTheTableAndAgreeWithThePrintedOneOn42Of49) {
  const auto generated = rules_from(delayed_1_response(Design{}));
  int equal = 0, within_one = 0;
  for (std::size_t i = 0; i < kFuzzyLabels; ++i)
    for (std::size_t j = 0; j < kFuzzyLabels; ++j) {
      EXPECT_GT(generated.degrees[i][j], 0.5) << i << " " << j;
      EXPECT_EQ(generated.rules[i][j], -generated.rules[6 - i][6 - j]) << "odd symmetry " << i << " " << j;
      const int difference = std::abs(generated.rules[i][j] - kPrintedRules[i][j]);
      equal += difference == 0;
      within_one += difference <= 1;
    }
  EXPECT_EQ(equal, 42);
  EXPECT_GE(within_one, 45);
}

TEST(PrintedRules, BreakOddSymmetryInOneCellOnly) {
  int breaks = 0;
  for (std::size_t i = 0; i < kFuzzyLabels; ++i)
    for (std::size_t j = 0; j < kFuzzyLabels; ++j)
      breaks += kPrintedRules[i][j] != -kPrintedRules[6 - i][6 - j];
  EXPECT_EQ(breaks, 2);  // the cell and its mirror
  EXPECT_EQ(kPrintedRules[kPB][5], 3);
  EXPECT_EQ(kPrintedRules[kPB][kPS], 2);
}

TEST(FuzzyLaw, ScalesByThePeriodOfTheLoadAndTheLargestSwing) {
  const Design design;
  Measurement m;
  m.position = {0.8, 0, 1.0};
  m.swing_radial_rad = design.fuzzy_swing_rad;  // PB at rest: PB
  const double per_volt = design.crane.gravity_mps2 / (4 * M_PI * M_PI * design.crane.trolley_gain_mps2pv);
  EXPECT_NEAR(make_fuzzy_printed(design)->step(m, {}).drive_v[kTrolley],
              -90 * design.fuzzy_swing_rad * per_volt, 1e-12);
  m.swing_radial_rad = 0;
  m.swing_radial_radps = 1.5 / 3 / (2 * M_PI * std::sqrt(1 / design.crane.gravity_mps2));  // ZO, PS: NS
  EXPECT_NEAR(make_fuzzy_printed(design)->step(m, {}).drive_v[kTrolley],
              90 * design.fuzzy_swing_rad / 3 * per_volt, 1e-12);
}

}  // namespace
}  // namespace crane::control
