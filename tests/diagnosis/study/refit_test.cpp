/// Refits of hypotheses with their own noise, and slopes that score tests share, on data of a crane that
/// shares no code with the model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "laboratory/strange_lab.hpp"
#include "search/compare.hpp"
#include "study/study.hpp"

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

/// Study of the crane with a drag, with the noise of the base model.
struct StudyOfADrag {
  StudyOfADrag() { study.learn_disturbance(); }
  [[nodiscard]] const Candidate* of_cause(const char* cause) const {
    return &*std::ranges::find(study.candidates(), std::string{cause}, &Candidate::cause);
  }

  configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/gantry.toml");
  Runs train = two_runs(crane_with_drag(), rig), none;
  Study study{rig, train, none, {}, kUsualAccuracy};
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
  StudyOfADrag at;
  Study& study = at.study;
  const Candidate* drag = at.of_cause("viscous_friction");
  const Fitted once = study.refit_with_own_noise(study.first_fit({{drag, {0.02}}}, study.base_model()));
  Fitted again = once;
  again.first_nuisance = once.nuisance;
  again = study.refit_with_own_noise(again);
  EXPECT_LT(sum(once.deviance) - sum(again.deviance), 2 * kLimit) << "minus twice the log likelihood";
}

/// A fit keeps its slopes while its steps decrease the loss as predicted. With slopes of the result, a fit
/// from there changes the values by a small part of their uncertainty.
TEST(Refit, WithSlopesOfEarlierValuesEndsAtTheMinimum) {
  constexpr double kSmall = 0.1;
  StudyOfADrag at;
  Study& study = at.study;
  for (const Effects& effects :
       {Effects{{at.of_cause("viscous_friction"), {0.02}}}, Effects{{at.of_cause("motor_gain"), {1.0}}},
        Effects{{at.of_cause("command_delay"), {0.01}}, {at.of_cause("cable_length"), {0.0}}}}) {
    const Fitted once = study.refit_with_own_noise(study.first_fit(effects, study.base_model()));
    const Fitted again = study.fit(once.effects, std::numeric_limits<double>::infinity(), once.train);
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
  StudyOfADrag at;
  Study& study = at.study;
  ProbeSlopes known;
  const ScoreTable first = study.score({}, study.base_train(), 1, known);
  EXPECT_EQ(largest_difference(first, study.score({}, study.base_train(), 1, known)), 0);

  const Candidate* drag = at.of_cause("viscous_friction");
  const Fitted with_drag = study.refit_with_own_noise(study.first_fit({{drag, {0.02}}}, study.base_model()));
  ProbeSlopes own;
  EXPECT_LT(largest_difference(study.score(with_drag.effects, with_drag.train, 1, known),
                               study.score(with_drag.effects, with_drag.train, 1, own)),
            kSmall);

  study.whiten_with(study.uncalibrated());
  own = {};
  EXPECT_LT(largest_difference(study.score({}, study.base_train(), 1, known),
                               study.score({}, study.base_train(), 1, own)),
            kSmall);
}

}  // namespace
}  // namespace crane::diagnosis
