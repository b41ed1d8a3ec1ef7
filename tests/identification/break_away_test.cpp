/// Break-aways from rest under slow voltage ramps.
#include "crane/identification/break_away.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crane::identification {
namespace {

/// Ramps of 0.4 V/s in both directions. The axis moves at 0.05 m/s when the voltage exceeds its stiction,
/// which varies by 10 mV.
AxisRun ramped_run(double holds_positive_v, double holds_negative_v, int ramps) {
  AxisRun run;
  double position = 0, volts = -2;  // and 2 V at the other end of the ramp
  for (int ramp = 0; ramp < ramps; ++ramp) {
    const int direction = ramp % 2 == 0 ? 1 : -1;
    const double varied = (ramp / 2) % 2 == 0 ? 0.01 : -0.01;
    const double holds = (direction > 0 ? holds_positive_v : holds_negative_v) + varied;
    for (int k = 0; k < 1000; ++k) {
      volts += direction * 0.4 * run.period_s;
      if (volts * direction > holds) position += direction * 0.05 * run.period_s;
      run.position.push_back(position);
      run.drive_v.push_back(volts);
    }
  }
  return run;
}

TEST(BreakAway, IsFoundInEitherDirectionWithItsSpread) {
  const auto found = estimate_stiction(ramped_run(0.9, 1.2, 8), {});
  // The window of 0.05 s and its threshold: at most 3 ticks of the ramp.
  EXPECT_NEAR(found.positive.mean_v, 0.9, 0.012);
  EXPECT_NEAR(found.negative.mean_v, 1.2, 0.012);
  EXPECT_EQ(found.positive.count, 4U);
  EXPECT_EQ(found.negative.count, 4U);
  EXPECT_NEAR(found.positive.spread_v, 0.01 * std::sqrt(4.0 / 3), 0.004);
}

TEST(BreakAway, IsNotAMotionAgainstTheVoltage) {
  AxisRun run = ramped_run(0.9, 1.2, 8);
  for (double& volts : run.drive_v) volts = -volts;
  EXPECT_TRUE(break_aways(run, {}).empty());
}

TEST(BreakAway, NeedsSeveralRepetitions) {
  EXPECT_THROW((void)estimate_stiction(ramped_run(0.9, 1.2, 2), {}), IdentificationError);
}

TEST(BreakAway, OfAnAxisThatNeverMovesIsRefused) {
  AxisRun run = ramped_run(100, 100, 4);
  EXPECT_THROW((void)estimate_stiction(run, {}), IdentificationError);
}

TEST(BreakAway, RefusesBadInput) {
  EXPECT_THROW((void)break_aways(ramped_run(0.9, 1.2, 4), {.start_speed = 0}), std::invalid_argument);
  AxisRun run = ramped_run(0.9, 1.2, 4);
  run.position[17] = std::nan("");
  EXPECT_THROW((void)break_aways(run, {}), IdentificationError);
}

}  // namespace
}  // namespace crane::identification
