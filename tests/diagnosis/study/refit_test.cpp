/// Refits of hypotheses with their own noise, and slopes that score tests share, on data of a crane that
/// shares no code with the model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "laboratory/strange_lab.hpp"
#include "search/compare.hpp"
#include "study/own_noise.hpp"
#include "study/score.hpp"

namespace crane::diagnosis {
namespace {

Runs two_runs(const strange::Gantry& crane, const configuration::Rig& rig) {
  Runs runs;
  for (const double direction : {1.0, -1.0}) {
    const auto truth = strange::moved(
        crane, 12, [direction](double t) { return 0.8 * direction * strange::rich_command(t); });
    const strange::Recording lab{.seed = direction > 0 ? 1U : 2U};
    for (Run& run : load_run(strange::recorded(truth, lab), rig, "drag.csv").runs)
      runs.push_back(prepare(std::move(run), rig));
  }
  return runs;
}

strange::Gantry crane_with_drag() {
  strange::Gantry crane;
  crane.gain_mps2pv *= 1.015;
  crane.cable_m *= 0.99;
  crane.drag_nspm = 3;
  return crane;
}

/// Study of the crane with a drag, and its data in the noise of the base model.
struct StudyOfADrag {
  [[nodiscard]] Fitted fitted(const Effects& effects) const {
    return refit_with_own_noise(study, base, first_fit(data, effects, base_fit(data)));
  }
  [[nodiscard]] const Candidate* of_cause(const char* cause) const {
    return &*std::ranges::find(study.candidates(), std::string{cause}, &Candidate::cause);
  }

  configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/gantry.toml");
  Runs train = two_runs(crane_with_drag(), rig), none;
  Study study{rig, train, none, {}, kUsualAccuracy};
  BaseModel base = learnt_base_model(study);
  WhitenedData data{study, base.calibrated};
};

/// Largest difference between the roots of the statistics of two score tests, among the significant
/// candidates. Noise gives the root of a chi-square statistic a standard deviation of 1.
double largest_difference(const ScoreTable& a, const ScoreTable& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.best.size(); ++i)
    if (std::min(a.best[i].p_value, b.best[i].p_value) < 0.01)
      largest = std::max(largest, std::abs(std::sqrt(a.best[i].statistic) - std::sqrt(b.best[i].statistic)));
  return largest;
}

/// A first fit keeps the gain and the cable length that the base model fitted without the drag, and its noise
/// model describes their errors as a disturbance. One round of fit and noise does not remove both.
TEST(Refit, EndsWhereARoundGainsLessThanTwiceItsLimit) {
  constexpr double kLimit = 2;
  const StudyOfADrag at;
  const Candidate* drag = at.of_cause("viscous_friction");
  const Fitted once = at.fitted({{drag, {0.02}}});
  Fitted again = once;
  again.first_nuisance = once.nuisance;
  again = refit_with_own_noise(at.study, at.base, again);
  EXPECT_LT(sum(once.deviance) - sum(again.deviance), 2 * kLimit) << "minus twice the log likelihood";
}

/// A fit keeps its slopes while its steps decrease the loss as predicted. With slopes of the result, a fit
/// from there changes the values by a small part of their uncertainty.
TEST(Refit, WithSlopesOfEarlierValuesEndsAtTheMinimum) {
  constexpr double kSmall = 0.1;
  const StudyOfADrag at;
  for (const Effects& effects :
       {Effects{{at.of_cause("viscous_friction"), {0.02}}}, Effects{{at.of_cause("motor_gain"), {1.0}}},
        Effects{{at.of_cause("command_delay"), {0.01}}, {at.of_cause("cable_length"), {0.0}}}}) {
    const Fitted once = at.fitted(effects);
    const WhitenedData data(at.study, once.nuisance);
    const Fitted again = fit(data, once.effects, kNothingToBeat, once.train);
    std::size_t value = 0;
    for (std::size_t i = 0; i < effects.size(); ++i)
      for (std::size_t k = 0; k < effects[i].values.size(); ++k, ++value)
        EXPECT_NEAR(again.effects[i].values[k], once.effects[i].values[k], kSmall * once.block_std_dev[value])
            << effects[i].candidate->label();
  }
}

/// The base model with the values of the rig file and the hypothesis of a drag use slopes of the calibrated
/// base model. With slopes of their own, their statistics differ by less than noise changes them.
TEST(ProbeSlopes, OfOneScoreTestServeLaterOnes) {
  constexpr double kSmall = 0.5;
  const StudyOfADrag at;
  ProbeSlopes known;
  const Evaluation base = at.data.base();
  const ScoreTable first = score_test(at.data, {}, base, 1, known);
  EXPECT_EQ(largest_difference(first, score_test(at.data, {}, base, 1, known)), 0);

  const Candidate* drag = at.of_cause("viscous_friction");
  const Fitted with_drag = at.fitted({{drag, {0.02}}});
  const WhitenedData beside_drag(at.study, with_drag.nuisance);
  ProbeSlopes own;
  EXPECT_LT(largest_difference(score_test(beside_drag, with_drag.effects, with_drag.train, 1, known),
                               score_test(beside_drag, with_drag.effects, with_drag.train, 1, own)),
            kSmall);

  const WhitenedData exact(at.study, at.base.exact);
  const Evaluation exact_base = exact.base();
  own = {};
  EXPECT_LT(largest_difference(score_test(exact, {}, exact_base, 1, known),
                               score_test(exact, {}, exact_base, 1, own)),
            kSmall);
}

}  // namespace
}  // namespace crane::diagnosis
