#include "crane/analysis/damping.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "crane/analysis/pade.hpp"
#include "crane/analysis/roots.hpp"

namespace crane::analysis {
namespace {

LoopDamping exact(AntiSwing law) {
  return [law](const GainPoint& gains) { return damping_of(characteristic(law, gains)); };
}

Optimum best(AntiSwing law, GainRange first, GainRange second, Measure measure) {
  const auto damping = exact(law);
  return optimum(damping, damping_map(damping, first, second), measure);
}

TEST(PrintedGains, HaveLessDampingInASecondPairThanInTheRightMostOne) {
  const auto pd = damping_of(characteristic(AntiSwing::pd, {-30, 8}));
  EXPECT_NEAR(pd.dominant, 0.432, 5e-4);
  EXPECT_NEAR(pd.least, 0.331, 5e-4);
  const auto first = damping_of(characteristic(AntiSwing::delayed_1, {-90, 0.1}));
  EXPECT_NEAR(first.dominant, 0.399, 5e-4);
  EXPECT_NEAR(first.least, 0.233, 5e-4);
  EXPECT_NEAR(std::abs(first.least_root - Complex(-2.48, 10.33)), 0, 0.01);
}

TEST(PrintedGains, OfDelayed2HaveTheStatedDampingOnlyWithIdealTracking) {
  const auto real = damping_of(characteristic(AntiSwing::delayed_2, {-0.33, 0.31}));
  EXPECT_NEAR(real.dominant, 0.061, 5e-4);
  EXPECT_NEAR(real.least, 0.061, 5e-4);
  EXPECT_NEAR(std::abs(real.least_root - Complex(-0.517, 8.458)), 0, 1e-3);
  EXPECT_NEAR(damping_of(perfectly_tracked_delayed_2({-0.33, 0.31})).dominant, 0.290, 5e-4);
}

TEST(PrintedGains, AreUnstableWithThePrintedSigns) {
  // (3.39) and (3.48) with +s^2 G_s, (3.50) with K_del = +0.33: docs/equations.md, errata.
  const auto right_most = [](AntiSwing law, GainPoint gains) {
    return roots_right_of(characteristic(law, gains), 0).front();
  };
  EXPECT_NEAR(std::abs(right_most(AntiSwing::pd, {30, -8}) - Complex(0.74, 5.68)), 0, 0.01);
  EXPECT_NEAR(std::abs(right_most(AntiSwing::delayed_1, {90, 0.1}) - Complex(1.36, 5.85)), 0, 0.01);
  EXPECT_NEAR(std::abs(right_most(AntiSwing::delayed_2, {0.33, 0.31}) - Complex(0.68, 5.81)), 0, 0.01);
}

TEST(Optimum, OfLeastDampingIsADoublePairForPdAndDelayed1) {
  const auto pd = best(AntiSwing::pd, {-80, 40, 25}, {-4, 16, 25}, Measure::least);
  EXPECT_NEAR(pd.damping.least, 0.3963, 5e-5);
  EXPECT_NEAR(pd.gains.first, -25.66, 0.01);
  EXPECT_NEAR(pd.gains.second, 7.434, 1e-3);
  EXPECT_NEAR(std::abs(pd.damping.least_root - Complex(-3.142, 7.277)), 0, 0.01);
  const auto delayed = best(AntiSwing::delayed_1, {-200, 40, 25}, {0.02, 0.32, 25}, Measure::least);
  EXPECT_NEAR(delayed.damping.least, 0.3808, 5e-5);
  EXPECT_NEAR(delayed.gains.first, -49.38, 0.02);
  EXPECT_NEAR(delayed.gains.second, 0.1193, 5e-5);
}

TEST(Optimum, OfLeastDampingForDelayed2DependsOnTheFrequencyRange) {
  const auto at = damping_of(characteristic(AntiSwing::delayed_2, {-0.423, 0.179}));
  EXPECT_NEAR(at.least, 0.1953, 5e-5);
  // Below eight load frequencies another optimum has more damping; the next root of its chain is slightly
  // above this limit.
  const auto found = best(AntiSwing::delayed_2, {-1.2, 0.4, 33}, {0.02, 0.62, 31}, Measure::least);
  EXPECT_NEAR(found.damping.least, 0.2219, 1e-4);
  EXPECT_NEAR(found.gains.first, -0.2255, 5e-4);
  EXPECT_NEAR(found.gains.second, 0.2758, 5e-4);
  EXPECT_LT(damping_of(characteristic(AntiSwing::delayed_2, found.gains), 60).least, 0.17);
}

TEST(Optimum, OfDominantDampingIsAtLeastTheBestOfAGrid) {
  EXPECT_GE(best(AntiSwing::pd, {-80, 40, 25}, {-4, 16, 25}, Measure::dominant).damping.dominant, 0.4495);
  EXPECT_GE(best(AntiSwing::delayed_1, {-200, 40, 25}, {0.02, 0.32, 25}, Measure::dominant).damping.dominant,
            0.425);
  EXPECT_GE(best(AntiSwing::delayed_2, {-1.2, 0.4, 33}, {0.02, 0.62, 31}, Measure::dominant).damping.dominant,
            0.263);
}

TEST(PadeApproximation, OfOrder20AgreesWithTheExactDampingOfThePrintedGainsWithinTwoPercent) {
  for (const auto& kind : kAntiSwingKinds) {
    const auto f = characteristic(kind.law, kind.printed);
    const auto exactly = damping_of(f), approximately = pade_damping_of(f, 20);
    EXPECT_NEAR(approximately.dominant / exactly.dominant, 1, 0.02) << kind.name;
    EXPECT_NEAR(approximately.least / exactly.least, 1, 0.02) << kind.name;
  }
}

TEST(PadeApproximation, ConvergesToTheExactRootsWithTheSquareOfItsOrder) {
  // ((1 - x) / (1 + x))^l with x = tau s / 2l is exp(-tau s (1 + x^2 / 3 + ...)).
  const auto f = characteristic(AntiSwing::delayed_1, {-90, 0.1});
  const Complex root = roots_right_of(f, -2).front();
  const double ten = std::abs(pade_roots(f, 10).front() - root);
  const double twenty = std::abs(pade_roots(f, 20).front() - root);
  EXPECT_NEAR(ten / twenty, 4, 0.05);
  EXPECT_LT(twenty, 1e-3);
}

TEST(PadeApproximation, RefusesEquationsThatItCannotApproximate) {
  const auto f = characteristic(AntiSwing::delayed_1, {-90, 0.1});
  EXPECT_THROW((void)pade_roots(f, 0), std::invalid_argument);
  EXPECT_THROW((void)pade_roots(perfectly_tracked_delayed_2({-0.33, 0.31}), 5), std::invalid_argument);
}

TEST(SwingFilter, ReducesTheDampingAndAShorterDelayRestoresIt) {
  // Section 4.3: cut-off 0.05 of 100 Hz, load period 2.006 s. Its delay is sqrt(2) / cutoff.
  const double cutoff = 2 * M_PI * 5 * 2.006;
  const auto law = AntiSwing::delayed_1;
  const double bare = damping_of(characteristic(law, {-90, 0.1})).least;
  const double filtered = damping_of(characteristic(law, {-90, 0.1}, {}, {cutoff})).least;
  const double shortened =
      damping_of(characteristic(law, {-90, 0.1 - std::sqrt(2) / cutoff}, {}, {cutoff})).least;
  EXPECT_LT(filtered, bare - 0.02);
  EXPECT_NEAR(shortened, bare, 0.02);
}

TEST(DampingMap, HasTheDampingOfEachGainAtItsPoint) {
  const auto damping = exact(AntiSwing::pd);
  const auto map = damping_map(damping, {-40, 0, 5}, {0, 12, 4});
  ASSERT_EQ(map.values.size(), 20u);
  EXPECT_EQ(map.at(1, 2).least, damping({-30, 8}).least);
}

}  // namespace
}  // namespace crane::analysis
