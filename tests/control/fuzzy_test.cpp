#include "crane/control/fuzzy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace crane::control {
namespace {

// Index of a label in the tables.
constexpr std::size_t kNM = 1, kNS = 2, kZO = 3, kPS = 4, kPB = 6;

TEST(FuzzyRules, HaveTheOutputOfTheirLabelAtEveryCentre) {
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

TEST(FuzzyRules, SaturateInputsBeyondTheLastLabel) {
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

TEST(GeneratedRules, FillTheTableAndAgreeWithThePrintedOne) {
  const auto generated = generated_rules(Design{});
  EXPECT_TRUE(missing_rules(generated).empty());
  for (std::size_t i = 0; i < kFuzzyLabels; ++i)
    for (std::size_t j = 0; j < kFuzzyLabels; ++j) {
      EXPECT_GT(generated.degrees[i][j], 0.5) << i << " " << j;
      EXPECT_EQ(generated.rules[i][j], -generated.rules[6 - i][6 - j]) << "odd symmetry " << i << " " << j;
    }
  const auto found = agreement(generated);
  RecordProperty("exact", found.exact);
  RecordProperty("within_one", found.within_one);
  EXPECT_GE(found.exact, 42);
  EXPECT_GE(found.within_one, 47);
  EXPECT_LT(found.mean_degree_difference, 0.1);
}

TEST(GeneratedRules, CountAgreementRuleByRule) {
  GeneratedRules printed{kPrintedRules, kPrintedDegrees};
  EXPECT_EQ(agreement(printed).exact, 49);
  EXPECT_EQ(agreement(printed).within_one, 49);
  EXPECT_EQ(agreement(printed).mean_degree_difference, 0);
  printed.rules[0][0] = 0;  // one label off
  printed.rules[0][1] = 3;  // six labels off
  printed.degrees[3][3] -= 0.49;
  EXPECT_EQ(agreement(printed).exact, 47);
  EXPECT_EQ(agreement(printed).within_one, 48);
  EXPECT_NEAR(agreement(printed).mean_degree_difference, 0.01, 1e-12);
}

TEST(GeneratedRules, NameTheRulesWithoutASample) {
  const auto one = rules_from({{1, 1, 1}, {0, 0, 0}});
  const auto missing = missing_rules(one);
  ASSERT_EQ(missing.size(), 47U);
  EXPECT_EQ(missing.front(), "(NB, NB)");
  EXPECT_EQ(std::count(missing.begin(), missing.end(), "(PB, PB)"), 0);
  EXPECT_EQ(std::count(missing.begin(), missing.end(), "(ZO, ZO)"), 0);
}

TEST(GeneratedRules, WithMissingRulesAreAProblemOfFuzzyGeneratedOnly) {
  Design design;
  design.fuzzy_swing_rate = 100;  // a rate that no load reaches
  ASSERT_TRUE(problems(design).empty());
  const auto found = problems(*find_controller("fuzzy_generated"), design);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].find("no rule for (NB, NB), (NB, NM), (NB, PM), (NB, PB) and 24 more: "),
            std::string::npos)
      << found[0];
  EXPECT_TRUE(problems(*find_controller("fuzzy_printed"), design).empty());
  for (const auto& controller : controllers()) EXPECT_TRUE(problems(controller, Design{}).empty());
}

TEST(MembershipPoints, MoveThePeaksOfAllThreeVariables) {
  const FuzzyPoints points{0.2, 0.7};
  EXPECT_NEAR(fuzzy_output(kPrintedRules, 0.2, 0, points), 0.2, 1e-12);   // (PS, ZO) = PS
  EXPECT_NEAR(fuzzy_output(kPrintedRules, 0, -0.7, points), 0.7, 1e-12);  // (ZO, NM) = PM
  EXPECT_NEAR(fuzzy_output(kPrintedRules, 0.45, 0, points), (0.2 + 0.7) / 2,
              1e-12);  // half PS, half PM: PS, PM
  const auto generated = rules_from({{0.1, 0, 0.1}}, points);
  EXPECT_NEAR(generated.degrees[kZO][kZO], 0.25, 1e-12);  // half ZO, ZO, half PS
}

TEST(MembershipPoints, ComeFromTheDesign) {
  Design design;
  design.fuzzy_point_a = 0.2;
  Measurement m;
  m.position = {0.8, 0, 1.0};
  m.swing_radial_rad = 0.2 * design.fuzzy_swing_rad;  // PS at rest: PS
  const double per_volt = design.crane.gravity_mps2 / (4 * M_PI * M_PI * design.crane.trolley_gain_mps2pv);
  EXPECT_NEAR(make_fuzzy_printed(design)->step(m, {}).drive_v[kTrolley],
              -90 * design.fuzzy_swing_rad * 0.2 * per_volt, 1e-12);
}

TEST(Labels, HaveTheNamesOfTheTables) {
  EXPECT_EQ(label_name(-3), "NB");
  EXPECT_EQ(label_name(0), "ZO");
  EXPECT_EQ(label_name(2), "PM");
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
