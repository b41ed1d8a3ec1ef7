/// Which hypothesis is better, from the losses of its blocks alone.
#include <gtest/gtest.h>

#include <numeric>

#include "search/compare.hpp"

namespace crane::diagnosis {
namespace {

constexpr std::size_t kTrainingBlocks = 90, kHeldOutBlocks = 45;
constexpr double kOfEach = 100;
constexpr std::uint64_t kSeed = 1;

Evaluation evaluation_of(const Blocks& blocks) {
  Evaluation evaluation;
  evaluation.blocks = blocks;
  evaluation.drive_blocks = blocks.size();
  evaluation.loss = evaluation.drive_loss = std::accumulate(blocks.begin(), blocks.end(), 0.0);
  evaluation.load_loss = 0;
  return evaluation;
}

struct Compared : testing::Test {
  Compared() { base.parameters = 0, fitted.parameters = 1; }
  /// After the blocks have been set.
  void evaluate() {
    for (auto& [of, training, held_out] :
         {std::tuple{&base, Blocks(kTrainingBlocks, kOfEach), Blocks(kHeldOutBlocks, kOfEach)},
          {&fitted, train, test}}) {
      of->train = evaluation_of(training);
      of->test = evaluation_of(held_out);
    }
  }
  Blocks train = Blocks(kTrainingBlocks, kOfEach), test = Blocks(kHeldOutBlocks, kOfEach);
  Fitted base, fitted;
};

TEST_F(Compared, AnEffectOfAllBlocksIsNotOutvotedByOneSlip) {
  for (double& block : train) block -= 2;
  for (double& block : test) block -= 2;
  train[35] -= 120, train[44] += 170;
  evaluate();
  EXPECT_TRUE(possible(fitted, base, kSeed));
  EXPECT_TRUE(accepted(fitted, base, base, kSeed));
}

TEST_F(Compared, OneSlipLessIsNoEffect) {
  train[35] -= 2000, test[3] -= 200;
  evaluate();
  EXPECT_FALSE(possible(fitted, base, kSeed));
  EXPECT_FALSE(accepted(fitted, base, base, kSeed));
}

TEST_F(Compared, AnEffectOfATenthOfTheBlocksIsOne) {
  for (std::size_t i = 0; i < train.size(); i += 10) train[i] -= 20;
  for (std::size_t i = 0; i < test.size(); i += 10) test[i] -= 20;
  evaluate();
  EXPECT_TRUE(accepted(fitted, base, base, kSeed));
}

TEST_F(Compared, WhatTheHeldOutDataSpeakAgainstIsPossibleAndNotAccepted) {
  for (double& block : train) block -= 4;
  for (double& block : test) block += 1;
  evaluate();
  EXPECT_TRUE(possible(fitted, base, kSeed));
  EXPECT_FALSE(accepted(fitted, base, base, kSeed));
}

TEST_F(Compared, WhatAFewHeldOutBlocksSpeakForIsLikelyAndNotAccepted) {
  for (double& block : train) block -= 4;
  test[7] -= 20, test[21] += 3;
  evaluate();
  EXPECT_FALSE(accepted(fitted, base, base, kSeed));
  EXPECT_TRUE(likely(fitted, base, kSeed));
}

TEST_F(Compared, WhatTheHeldOutDataSpeakAgainstIsNotLikely) {
  for (double& block : train) block -= 4;
  for (double& block : test) block += 1;
  evaluate();
  EXPECT_FALSE(likely(fitted, base, kSeed));
}

/// Two causes of one drive; the first is the best.
struct Rivals : Compared {
  Rivals() {
    for (Candidate* candidate : {&first, &second}) candidate->drive = true;
    fitted.effects = {{&first, {}}};
    base.effects = {{&second, {}}};
    base.parameters = 1;
  }
  /// @param explained in each training block by the second
  [[nodiscard]] double votes_for_second(double explained = 100) {
    Fitted neither;
    neither.train = evaluation_of(Blocks(kTrainingBlocks, kOfEach + explained));
    return frequencies(fitted, {&base}, neither, kSeed).at(0);
  }
  Candidate first, second;
};

TEST_F(Rivals, WhatIsBetterInTrainingWinsTheVotesWhenTheHeldOutDataAreAlike) {
  for (double& block : train) block -= 4;
  test[3] -= 10, test[9] += 10;
  evaluate();
  EXPECT_LT(votes_for_second(), 0.05);
}

TEST_F(Rivals, WhatOneMoreParameterGainsInTrainingOnlyLeavesTheVotesOpen) {
  for (double& block : train) block -= 4;
  test[3] -= 10, test[9] += 10;
  fitted.parameters = 2;
  evaluate();
  EXPECT_GT(votes_for_second(), 0.2);
}

TEST_F(Rivals, WhatOneMoreParameterExplainsHalfAsMuchAgainWinsTheVotes) {
  for (double& block : train) block -= 4;
  test[3] -= 10, test[9] += 10;
  fitted.parameters = 2;
  evaluate();
  EXPECT_LT(votes_for_second(8), 0.05);
}

TEST_F(Rivals, WhatOneMoreParameterGainsOutOfSampleTooWinsTheVotes) {
  for (double& block : train) block -= 4;
  for (double& block : test) block -= 4;
  fitted.parameters = 2;
  evaluate();
  EXPECT_LT(votes_for_second(), 0.05);
}

}  // namespace
}  // namespace crane::diagnosis
