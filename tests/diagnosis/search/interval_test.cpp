/// Standard deviations of fitted values, against the scatter about the truth over many laboratories.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "laboratory/strange_lab.hpp"
#include "search/intervals.hpp"
#include "study/own_noise.hpp"
#include "study/uncertainty.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kOffset_rad = 0.02, kCount_rad = 1e-3;
constexpr unsigned kSeed = 4711;

/// Two free swings, read by an encoder whose zero is anywhere within one of its counts.
Runs free_swings(const configuration::Rig& rig, std::mt19937_64& random) {
  const double zero_rad = std::uniform_real_distribution{-0.5, 0.5}(random)*kCount_rad;
  Runs runs;
  for (const double start_rad : {0.15, -0.1}) {
    strange::Recording lab;
    lab.seed = random();
    lab.swing_step_rad = kCount_rad;
    lab.swing_noise_rad = 3e-4;
    auto truth = strange::moved(
        {}, 12, [](double) { return 0.0; }, start_rad);
    for (strange::Instant& instant : truth) instant.swing_rad += kOffset_rad + zero_rad;
    for (Run& run : load_run(strange::recorded(truth, lab), rig, "swing.csv").runs)
      runs.push_back(prepare(std::move(run), rig));
  }
  return runs;
}

/// Twenty encoders: without the error of the zero, the standard deviation is a hundredth of a count.
TEST(IntervalOfASwingOffset, ContainsTheErrorOfTheZeroOfTheEncoder) {
  const configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/gantry.toml");
  constexpr int kEncoders = 20;
  std::mt19937_64 random(kSeed);
  int within_two = 0;
  for (int encoder = 0; encoder < kEncoders; ++encoder) {
    const Runs train = free_swings(rig, random), none;
    const Study study(rig, train, none);
    const auto offset = std::ranges::find_if(study.candidates(),
                                             [](const Candidate& c) { return c.cause == "swing_offset"; });
    ASSERT_NE(offset, study.candidates().end());
    const Effects effects{{&*offset, {kOffset_rad}}};
    const WhitenedData data(study, learnt_nuisance(study, effects));
    const Fitted fitted = with_intervals(data, fit(data, effects, kNothingToBeat, data.base()), 1);
    const double error = fitted.effects[0].values[0] - kOffset_rad;
    within_two += std::abs(error) <= 2 * fitted.interval_std_dev[0] ? 1 : 0;
    EXPECT_NEAR(fitted.interval_std_dev[0], kCount_rad / std::sqrt(12), 0.1 * kCount_rad) << "seed " << kSeed;
  }
  EXPECT_GE(within_two, kEncoders - 1) << "seed " << kSeed;
}

}  // namespace
}  // namespace crane::diagnosis
