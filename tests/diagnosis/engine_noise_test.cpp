/// What a crane leaves that is exactly as modelled, in units of the noise learnt from it.
#include <gtest/gtest.h>

#include "sealed_case.hpp"
#include "study.hpp"
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

double mean_square(const Fits& fits) {
  double sum = 0, count = 0;
  for (const WindowFit& fit : fits)
    sum += fit.residual.squaredNorm(), count += static_cast<double>(fit.residual.size());
  return sum / count;
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
  Study study(rig, train, {});
  study.learn_disturbance();
  EXPECT_GT(mean_square(study.base_train().drive), 0.6);
  EXPECT_LT(mean_square(study.base_train().drive), 1.5);
  if (!study.load().empty()) {
    EXPECT_NEAR(mean_square(study.base_train().load), 1, 0.1);
  }
}
INSTANTIATE_TEST_SUITE_P(OfRigs, Noise, testing::Values("tower", "gantry", "drive_axis"),
                         [](const auto& tested) { return std::string{tested.param}; });

}  // namespace
}  // namespace crane::diagnosis
