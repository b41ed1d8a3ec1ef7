/// Comparison of hypotheses by the deviance of their blocks and the errors of their simulation.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "search/block_votes.hpp"
#include "search/compare.hpp"

namespace crane::diagnosis {
namespace {

constexpr std::size_t kBlocks = 90;
constexpr double kBlockDeviance = 100;
constexpr std::uint64_t kSeed = 1;
constexpr std::size_t kCandidates = 40;

/// A base model with an error of 1 m of one drive, and one effect on this drive.
struct Compared : testing::Test {
  Compared() {
    effect.drive = true;
    effect.axis = "trolley";
    fitted.effects = {{&effect, {}}};
    for (Fitted* of : {&base, &fitted}) {
      of->deviance.assign(kBlocks, kBlockDeviance);
      of->train.drive_blocks = kBlocks;
    }
    base.error[kTrolleyPosition] = 1;
    fitted.error[kTrolleyPosition] = 0.8;
  }
  [[nodiscard]] bool is_likelier() const { return likelier_in_resamples(fitted, base, kSeed); }
  [[nodiscard]] bool is_accepted() const { return accepted(fitted, base, kCandidates); }

  Candidate effect, other;
  Fitted base, fitted;
};

TEST_F(Compared, OneOutlierBlockDoesNotRejectACause) {
  for (double& block : fitted.deviance) block -= 2;
  fitted.deviance[35] -= 120, fitted.deviance[44] += 170;
  EXPECT_TRUE(is_likelier());
  EXPECT_TRUE(is_accepted());
}

TEST_F(Compared, OneBetterBlockIsNotAccepted) {
  fitted.deviance[35] -= 2000;
  EXPECT_FALSE(is_likelier());
  EXPECT_FALSE(is_accepted());
}

/// A significance that one candidate reaches by chance in one of 200 cases is reached by the best of forty
/// candidates in one of five cases.
TEST_F(Compared, TheBestOfManyCandidatesNeedsMoreEvidenceThanASingleOne) {
  for (std::size_t i = 0; i < kBlocks; ++i) fitted.deviance[i] -= i % 3 == 0 ? -4 : 4;
  EXPECT_LT(block_test_p_value(fitted.deviance, base.deviance), 0.01);
  EXPECT_TRUE(accepted(fitted, base, 1));
  for (std::size_t i = 0; i < kBlocks; ++i) fitted.deviance[i] += 0.36;
  const double luck = block_test_p_value(fitted.deviance, base.deviance);
  EXPECT_LT(luck, 0.01);
  EXPECT_GT(luck * kCandidates, 0.05);
  EXPECT_TRUE(accepted(fitted, base, 1));
  EXPECT_FALSE(is_accepted());
}

/// Without an effect the p value is uniformly distributed: it is below 0.05 in 5 % of the cases.
TEST_F(Compared, PValuesAreUniformWithoutAnEffect) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> gauss;
  int below = 0;
  constexpr int kCases = 2000;
  for (int i = 0; i < kCases; ++i) {
    for (double& block : fitted.deviance) block = kBlockDeviance + gauss(random);
    below += block_test_p_value(fitted.deviance, base.deviance) < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(below, 0.05 * kCases, 4 * std::sqrt(0.05 * 0.95 * kCases));
}

/// If each block is slightly likelier than before, the scatter of the blocks cannot explain the gain. The
/// gain results from the fit of the additional value.
TEST_F(Compared, AnAdditionalValueMustIncreaseTheLikelihoodMoreThanChanceDoes) {
  fitted.parameters = 1;
  for (std::size_t i = 0; i < kBlocks; ++i) fitted.deviance[i] -= i % 2 == 0 ? 0.01 : 0.03;
  EXPECT_LT(block_test_p_value(fitted.deviance, base.deviance), 1e-6);
  EXPECT_TRUE(insignificant(likelihood_ratio_p_value(fitted, base), kCandidates));
  EXPECT_FALSE(is_accepted());
  for (std::size_t i = 0; i < kBlocks; ++i) fitted.deviance[i] -= 0.1;
  EXPECT_TRUE(is_accepted());
  EXPECT_TRUE(insignificant(likelihood_ratio_p_value(fitted, base, -5), kCandidates));
}

/// The sum of two losses of the same data has twice the information of the data: the scores scatter twice as
/// much.
TEST_F(Compared, AnAdditionalValueOfTwoAddedLossesNeedsTwiceTheGain) {
  fitted.parameters = 1;
  for (double& block : fitted.deviance) block -= 16.0 / kBlocks;
  const double of_one_view = likelihood_ratio_p_value(fitted, base);
  EXPECT_NEAR(of_one_view, std::erfc(std::sqrt(16.0 / 2)), 1e-9);
  fitted.left_out.assign(kBlocks, 4.0 / kBlocks);  // 2 tr(H^-1 J) = 4
  EXPECT_NEAR(likelihood_ratio_p_value(fitted, base), std::erfc(std::sqrt(8.0 / 2)), 1e-9);
}

TEST_F(Compared, ASuperfluousValueReducesTheHeldOutLikelihoodOnlySlightly) {
  fitted.parameters = 1;
  EXPECT_TRUE(insignificant(held_out_loss_p_value(fitted, base, 3), kCandidates));
  EXPECT_TRUE(insignificant(held_out_loss_p_value(fitted, base, -3), kCandidates));
  EXPECT_FALSE(insignificant(held_out_loss_p_value(fitted, base, -30), kCandidates));
}

TEST_F(Compared, AnAmountWhoseIntervalContainsZeroIsNotSignificant) {
  const auto neutral_at = [](double null) {
    FreeParameter parameter;
    parameter.null = null;
    return parameter;
  };
  effect.parameters = {neutral_at(1),
                       neutral_at(0)};  // a factor, which is an amount, and a decay speed, which is not
  other.parameters = {neutral_at(0)};
  fitted.effects = {{&effect, {1.5, 0.1}}, {&other, {-0.196}}};
  fitted.interval_std_dev = {0.1, 0.09, 0.1};
  EXPECT_NEAR(wald_p_value(fitted), 0.05, 1e-4);  // 1.96 standard deviations of `other`
  fitted.interval_std_dev = {0.1, 0.09, 0.02};
  EXPECT_NEAR(wald_p_value(fitted), 5.7e-7, 1e-8);  // 5 standard deviations of the factor
  fitted.interval_std_dev = {0.5, 1e-6, 0.02};
  // 1 standard deviation of the factor; the accuracy of the decay speed has no influence
  EXPECT_NEAR(wald_p_value(fitted), 0.3173, 1e-4);
  effect.amount_count = 2;
  fitted.interval_std_dev = {0.5, 0.02, 0.02};
  EXPECT_NEAR(wald_p_value(fitted), 5.7e-7, 1e-8);  // 5 standard deviations of the second amount
}

TEST_F(Compared, ARareCauseNeedsAMarginOverTheCommonCause) {
  effect.cause = "drive_inertia";
  other.cause = "motor_gain";
  effect.axis = other.axis = "trolley";
  effect.rarer_than = other.cause;
  Fitted rare, common;
  rare.effects = {{&effect, {1.1}}};
  common.effects = {{&other, {0.9}}};
  common.deviance = {100};
  rare.deviance = {94};
  EXPECT_TRUE(less(common, rare)) << "6 below the common cause";
  rare.deviance = {93};
  EXPECT_TRUE(less(rare, common)) << "7 below the common cause";
  EXPECT_TRUE(differs_by_rarer_causes(rare.effects, common.effects));
  EXPECT_FALSE(differs_by_rarer_causes(common.effects, rare.effects));
  other.axis = "slew";
  EXPECT_FALSE(differs_by_rarer_causes(rare.effects, common.effects)) << "another axis is no twin";
}

TEST_F(Compared, AnEffectInATenthOfTheBlocksIsSignificant) {
  for (std::size_t i = 0; i < kBlocks; i += 10) fitted.deviance[i] -= 20;
  EXPECT_TRUE(is_accepted());
}

TEST_F(Compared, ALargerLikelihoodWithoutASmallerErrorIsNotAccepted) {
  for (double& block : fitted.deviance) block -= 4;
  fitted.error[kTrolleyPosition] = 0.999;
  EXPECT_TRUE(is_likelier());
  EXPECT_FALSE(is_accepted());
}

/// A term describes an effect with an error of a few percent. A second effect of this size could be the
/// description of this error.
TEST_F(Compared, ASecondCauseMustChangeAnOutputByNinePercentOfTheChangeByTheFirst) {
  for (double& block : fitted.deviance) block -= 4;
  Fitted before = base;
  other.drive = true;
  other.axis = "trolley";
  before.effects = {{&other, {}}};
  fitted.effects.push_back({&other, {}});
  fitted.change.assign(2, {});
  fitted.change[0][kTrolleyPosition] = 0.008;
  fitted.change[1][kTrolleyPosition] = 0.1;
  EXPECT_FALSE(accepted(fitted, before, kCandidates));
  fitted.change[0][kTrolleyPosition] = 0.01;
  EXPECT_TRUE(accepted(fitted, before, kCandidates));
  fitted.error[kTrolleyPosition] = 1.001;
  EXPECT_FALSE(accepted(fitted, before, kCandidates)) << "the error must not increase";
}

TEST_F(Compared, ASecondEffectOnAnotherOutputMayBeSmall) {
  for (double& block : fitted.deviance) block -= 4;
  Fitted before = base;
  before.effects = {{&other, {}}};
  fitted.effects.push_back({&other, {}});
  fitted.change.assign(2, {});
  fitted.change[0][kTrolleyPosition] = 0.001;
  fitted.change[1][kSlewAngle] = 0.1;
  EXPECT_TRUE(accepted(fitted, before, kCandidates));
}

TEST_F(Compared, ForASwingASmallerErrorOverWholeRunsSuffices) {
  effect.drive = false, effect.load = true;
  effect.axis = "radial";
  for (double& block : fitted.deviance) block -= 4;
  base.error[kRadialSwing] = fitted.error[kRadialSwing] = 1;
  base.whole_error[kRadialSwing] = 2, fitted.whole_error[kRadialSwing] = 1;
  EXPECT_TRUE(is_accepted());
}

TEST_F(Compared, AnEffectIsNotJudgedByColumnsItDoesNotActOn) {
  for (double& block : fitted.deviance) block -= 4;
  base.error[kSlewAngle] = 1, fitted.error[kSlewAngle] = 0.1;
  fitted.error[kTrolleyPosition] = 1;
  EXPECT_FALSE(is_accepted());
}

/// Two causes of one drive; `fitted` is the best hypothesis.
struct Rivals : Compared {
  Rivals() {
    other.drive = true;
    other.axis = "trolley";
    rival = base;
    rival.effects = {{&other, {}}};
  }
  [[nodiscard]] double votes_for_rival() const {
    return shares_of_votes(fitted, {&rival}, base, kSeed).at(0);
  }
  Fitted rival;
};

TEST_F(Rivals, AHypothesisThatImprovesEveryBlockWinsTheVotes) {
  for (double& block : fitted.deviance) block -= 4;
  EXPECT_EQ(votes_for_rival(), 0);
}

TEST_F(Rivals, EquallyManyBetterAndWorseBlocksSplitTheVote) {
  for (std::size_t i = 0; i < kBlocks; ++i) fitted.deviance[i] += i % 2 == 0 ? -4 : 4;
  fitted.deviance[0] -= 4;
  EXPECT_GT(votes_for_rival(), 0.2);
}

/// 0.25 % and 2.5 % of the gain.
TEST_F(Rivals, OfNearlyEqualDevianceShareTheVote) {
  for (double& block : fitted.deviance) block -= 4;
  rival.deviance = fitted.deviance;
  for (double& block : rival.deviance) block += 0.01;
  EXPECT_NEAR(votes_for_rival(), 0.5, 1e-9);
  for (double& block : rival.deviance) block += 0.09;
  EXPECT_EQ(votes_for_rival(), 0);
}

TEST_F(Rivals, AreComparedOnlyWhereTheyReplaceEachOther) {
  fitted.train.drive_blocks = rival.train.drive_blocks = kBlocks / 2;
  for (std::size_t i = kBlocks / 2; i < kBlocks; ++i) fitted.deviance[i] += 40;  // blocks of the load
  for (std::size_t i = 0; i < kBlocks / 2; ++i) fitted.deviance[i] -= 1;
  EXPECT_EQ(votes_for_rival(), 0);
}

}  // namespace
}  // namespace crane::diagnosis
