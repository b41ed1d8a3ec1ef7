/// Which hypotheses a search fits and refits.
#include "search/prospects.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "search/compare.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kLoss = 6000;

struct Prospects : testing::Test {
  Prospects() {
    drag.cause = "drag", friction.cause = "friction", delay.cause = "delay";
    drag.axis = friction.axis = delay.axis = "trolley";
    drag.drive = friction.drive = delay.drive = true;
    given.train.drive_loss = kLoss;
    best.effects = {{&drag, {}}};
    best.misfit = 1000;
    base.error[kTrolleyPosition] = 1;
  }
  [[nodiscard]] double reachable(double share) const {
    Score score;
    score.share = share;
    return reachable_decrease(score, drag, given);
  }
  /// A first fit with a reduction of the error.
  static Fitted first_fit(Effects effects, double misfit, double reduction) {
    Fitted fitted;
    fitted.effects = std::move(effects);
    fitted.misfit = misfit;
    fitted.error[kTrolleyPosition] = 1 - reduction;
    return fitted;
  }
  [[nodiscard]] std::vector<std::string> refitted(std::vector<Fitted> first_fits) const {
    std::vector<std::string> labels;
    for (const Fitted& fitted : worth_a_refit(std::move(first_fits), base, best))
      labels.push_back(label_of(fitted.effects));
    return labels;
  }

  Candidate drag, friction, delay;
  Fitted given, base, best;
};

/// n ln(1 / (1 - s)) is the decrease of n ln(variance) when the share s of the squares is removed.
TEST_F(Prospects, ReachableDecreaseIsFiftyTimesThePrediction) {
  EXPECT_NEAR(reachable(1e-7), 50 * 1e-7 * kLoss, 1e-6);
  EXPECT_NEAR(reachable(0.016), kLoss * std::log(1 / (1 - 0.8)), 1e-6);
  EXPECT_TRUE(std::isinf(reachable(0.02)));
  EXPECT_EQ(reachable(-0.1), 0);
}

TEST_F(Prospects, ACauseWhoseScorePredictsNothingMayReachAnyDeviance) {
  drag.rough = true;
  EXPECT_TRUE(std::isinf(reachable(0)));
  drag.rough = false;
  drag.ringing_starts_at = [](double /*hz*/) { return std::vector<std::vector<double>>{}; };
  EXPECT_TRUE(std::isinf(reachable(0)));
}

TEST_F(Prospects, ALargerHypothesisIsRefittedOnlyIfItsFirstFitIsLikelier) {
  const Effects pair{{&drag, {}}, {&friction, {}}}, other{{&drag, {}}, {&delay, {}}};
  EXPECT_EQ(refitted({first_fit(pair, 999, 0), first_fit(other, 1000, 0.5)}),
            std::vector<std::string>{label_of(pair)});
  EXPECT_EQ(refitted({first_fit({{&friction, {}}}, 2000, 0)}).size(), 1U) << "a rival of the same size";
}

TEST_F(Prospects, TwoAreRefittedForTheirLikelihoodAndTwoForTheirError) {
  best.effects.clear();
  best.misfit = 1e9;
  std::vector<Candidate> causes(6, drag);
  std::vector<Fitted> first_fits;
  for (std::size_t i = 0; i < causes.size(); ++i) {
    causes[i].cause = std::string(1, static_cast<char>('a' + i));
    first_fits.push_back(first_fit({{&causes[i], {}}}, static_cast<double>(i), 0.1 * static_cast<double>(i)));
  }
  first_fits.push_back(first_fit({{&causes[0], {}}}, 7, 0.9));  // a less likely fit of the same effect
  EXPECT_EQ(refitted(first_fits),
            (std::vector<std::string>{"a (trolley)", "b (trolley)", "f (trolley)", "e (trolley)"}));
}

}  // namespace
}  // namespace crane::diagnosis
