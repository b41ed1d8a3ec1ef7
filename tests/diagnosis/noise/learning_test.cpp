/// Mean loss of the residual of the right model, in units of its learnt noise.
#include <gtest/gtest.h>

#include "laboratory/data_of_truth.hpp"
#include "robust.hpp"
#include "study/own_noise.hpp"

namespace crane::diagnosis {
namespace {

/// The mean loss of white noise is 1.
double mean_loss(const Fits& fits) {
  double sum = 0, count = 0;
  for (const WindowFit& fit : fits)
    sum += loss_of(fit.residual), count += static_cast<double>(fit.residual.size());
  return sum / (kMeanLoss * count);
}

class NoiseOfARig : public testing::TestWithParam<const char*> {};

/// If a start is not estimated, in particular the speed of a drive, the loss is four to eight times as large.
TEST_P(NoiseOfARig, IsThatOfTheResidualOfTheRightModel) {
  truth::Case request;
  request.rig = GetParam();
  request.seed = 29;
  request.seconds = 20;
  const DataOfTruth data(request);
  const Runs none;
  const Study study(data.rig, data.train, none);
  const WhitenedData whitened(study, learnt_base_model(study).calibrated);
  const Evaluation base = whitened.base();
  EXPECT_GT(mean_loss(base.drive), 0.9);
  EXPECT_LT(mean_loss(base.drive), 1.3);
  if (!whitened.load().empty()) {
    EXPECT_NEAR(mean_loss(base.load), 1, 0.1);
  }
}
INSTANTIATE_TEST_SUITE_P(OfRigs, NoiseOfARig, testing::Values("tower", "gantry", "drive_axis"),
                         [](const auto& tested) { return std::string{tested.param}; });

}  // namespace
}  // namespace crane::diagnosis
