/// Refits of hypotheses with their own noise, on data of a crane that shares no code with the model.
#include <gtest/gtest.h>

#include <algorithm>

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

/// A first fit keeps the gain and the cable length that the base model fitted without the drag, and its noise
/// model describes their errors as a disturbance. One round of fit and noise does not remove both.
TEST(Refit, EndsWhereARoundGainsLessThanTwiceItsLimit) {
  constexpr double kLimit = 2;
  const configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/gantry.toml");
  strange::Gantry crane;
  crane.gain_mps2pv *= 1.015;
  crane.cable_m *= 0.99;
  crane.drag_nspm = 3;
  const Runs train = two_runs(crane, rig), none;
  Study study(rig, train, none, {}, kUsualAccuracy);
  study.learn_disturbance();
  const auto drag = std::ranges::find(study.candidates(), std::string{"viscous_friction"}, &Candidate::cause);
  ASSERT_NE(drag, study.candidates().end());
  const Fitted once = study.refit_with_own_noise(study.first_fit({{&*drag, {0.02}}}, study.base_model()));
  Fitted again = once;
  again.first_nuisance = once.nuisance;
  again = study.refit_with_own_noise(again);
  EXPECT_LT(sum(once.deviance) - sum(again.deviance), 2 * kLimit) << "minus twice the log likelihood";
}

}  // namespace
}  // namespace crane::diagnosis
