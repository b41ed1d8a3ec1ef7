/// What a crane leaves that is exactly as modelled, in units of the noise learnt from it.
#include <gtest/gtest.h>

#include "robust.hpp"
#include "sealed_case.hpp"
#include "study/study.hpp"
#include "truth/truth.hpp"

namespace crane::diagnosis {
namespace {

Runs runs_of(const std::vector<truth::Run>& runs, const runtime::Rig& rig) {
  Runs all;
  for (const truth::Run& run : runs)
    for (Run& piece : load_run(recording::parse_csv(truth::csv(run), run.file), rig, run.file).runs)
      all.push_back(prepare(std::move(piece), rig));
  return all;
}

/// 1 of white noise.
double mean_loss(const Fits& fits) {
  double sum = 0, count = 0;
  for (const WindowFit& fit : fits)
    sum += loss_of(fit.residual), count += static_cast<double>(fit.residual.size());
  return sum / (kMeanLoss * count);
}

class Noise : public testing::TestWithParam<const char*> {};

/// A start that is not solved for, the speed of a drive above all, leaves four to eight times as much.
TEST_P(Noise, LearntFromACraneAsModelledIsWhatItLeaves) {
  truth::Case request;
  request.rig = GetParam();
  request.seed = 29;
  request.seconds = 20;
  const runtime::Rig rig = score::rig_file_of(request.rig);
  const Runs train = runs_of(truth::generate(request).training, rig);
  const Runs none;
  Study study(rig, train, none);
  study.learn_disturbance();
  EXPECT_GT(mean_loss(study.base_train().drive), 0.9);
  EXPECT_LT(mean_loss(study.base_train().drive), 1.3);
  if (!study.load().empty()) {
    EXPECT_NEAR(mean_loss(study.base_train().load), 1, 0.1);
  }
}
INSTANTIATE_TEST_SUITE_P(OfRigs, Noise, testing::Values("tower", "gantry", "drive_axis"),
                         [](const auto& tested) { return std::string{tested.param}; });

}  // namespace
}  // namespace crane::diagnosis
