/// Starts and intervals of fits, on data of a crane that shares no code with the model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "laboratory/data_of_truth.hpp"
#include "search/compare.hpp"
#include "search/drive_pairs.hpp"
#include "search/intervals.hpp"
#include "search/score_tests.hpp"
#include "search/search.hpp"
#include "truth/truth.hpp"

namespace crane::diagnosis {
namespace {

/// The loss has a local minimum at a small delay: a fit from a small delay ends at 1 ms.
TEST(Search, FindsALongDelayOfTheCommand) {
  truth::Case request;
  request.rig = "drive_axis";
  request.seed = 3;
  request.seconds = 20;
  request.effects = {{"command_delay", 3, "trolley"}};
  const DataOfTruth data(request);
  const Study study(data.rig, data.train, data.test);
  const Fitted best = searched(study, learnt_base_model(study), {.most_effects = 1}).best;
  ASSERT_EQ(label_of(best.effects), "command_delay (trolley)");
  EXPECT_NEAR(best.effects[0].values[0], 0.105, 0.05 * 0.105);
}

/// The effects partly cancel: without the lower Coulomb friction, the fit of the Stribeck friction
/// compensates with a smaller excess, and a lower Coulomb friction alone does not improve the simulation. The
/// truth has the exponential form of the Stribeck friction.
TEST(Search, FindsALowerCoulombFrictionBesideAStribeckFriction) {
  truth::Case request;
  request.rig = "tower";
  request.training_runs = {"rich"};
  request.seed = 3;
  request.seconds = 30;
  request.effects = {{"coulomb_friction", -0.62, "trolley"}, {"stribeck_friction", 1.2, "trolley"}};
  const DataOfTruth data(request);
  const Study study(data.rig, data.train, data.test);
  const WhitenedData whitened(study, learnt_nuisance(study));
  const Fitted base = base_fit(whitened);
  ScoreTests scores(request.seed);
  (void)scores.beside(whitened, base);
  const std::vector<Effects> pairs = strongest_drive_pairs(whitened, base.train, scores.probe_slopes(), 1);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(label_of(pairs[0]), "coulomb_friction (trolley) + stribeck_friction (trolley)");
  EXPECT_NEAR(pairs[0][0].values[0], -0.186, 0.05) << "Coulomb friction, V";
}

/// If the amount of its further effect is 0, a hypothesis is as likely as its part.
TEST(Search, FindsNoHypothesisLessLikelyThanOneOfItsParts) {
  constexpr double kTolerance_nats = 3;  // a fit ends when a round decreases the loss by less
  for (const unsigned seed : {5U, 6U}) {
    truth::Case request;
    request.rig = "drive_axis";
    request.seed = seed;
    request.seconds = 20;
    request.effects = {{"command_offset", 2, "trolley"}, {"coulomb_friction", 2, "trolley"}};
    const DataOfTruth data(request);
    const Study study(data.rig, data.train, data.test);
    const Hypotheses found = searched(study, learnt_base_model(study), {.most_effects = 2});
    const auto likelihood = [](const Fitted& f) { return -0.5 * (sum(f.deviance) - f.penalty); };
    for (const Fitted& whole : found.all)
      for (const Fitted& part : found.all) {
        const bool contained = part.effects.size() < whole.effects.size() &&
                               std::ranges::all_of(part.effects, [&](const Effect& effect) {
                                 return has(whole.effects, effect.candidate);
                               });
        if (!contained) continue;
        EXPECT_GT(likelihood(whole), likelihood(part) - kTolerance_nats)
            << label_of(whole.effects) << " and its part " << label_of(part.effects) << ", seed " << seed;
      }
  }
}

/// The loss is rough, because the axis breaks loose earlier or later. This roughness exceeds the differences
/// between neighbouring amplitudes.
TEST(Intervals, OfARippleContainTheTruthDespiteARoughLoss) {
  constexpr double kAmplitude_v = 0.6, kWavelength_m = 0.0127;
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    truth::Case request;
    request.rig = "drive_axis";
    request.seed = seed;
    request.seconds = 20;
    request.effects = {{"torque_ripple", 1, "trolley"}};
    const truth::Data generated = truth::generate(request);
    const DataOfTruth data(request);
    const Study study(data.rig, data.train, data.test);
    const auto ripple = std::find_if(study.candidates().begin(), study.candidates().end(),
                                     [](const Candidate& c) { return c.waves; });
    const auto& answer = generated.answer[0].parameters;
    const auto phase = std::find_if(answer.begin(), answer.end(),
                                    [](const truth::Value& v) { return v.name == "phase_rad"; });
    ASSERT_NE(phase, answer.end());
    const Effects hidden{{&*ripple, {kAmplitude_v, phase->value, kWavelength_m}}};
    const WhitenedData whitened(study, learnt_nuisance(study, hidden));
    const Fitted fitted =
        with_intervals(whitened, fit(whitened, hidden, kNothingToBeat, whitened.base()), seed);
    const auto error = [&](std::size_t i) {
      return std::abs(fitted.effects[0].values[i] - hidden[0].values[i]);
    };
    EXPECT_LE(error(0), 3 * fitted.interval_std_dev[0]) << "seed " << seed;
    EXPECT_LE(error(2), 3 * fitted.interval_std_dev[2]) << "seed " << seed;
    EXPECT_LT(fitted.interval_std_dev[0], 0.1 * kAmplitude_v) << "seed " << seed;
    EXPECT_LT(fitted.interval_std_dev[2], 1e-3 * kWavelength_m) << "seed " << seed;
  }
}

}  // namespace
}  // namespace crane::diagnosis
