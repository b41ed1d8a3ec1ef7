// Fits of a swinging load.
#include "crane/bring_up/swing_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crane::bring_up {
namespace {

constexpr double kFrequency_radps = 3.1;

Record swinging(double offset, double cosine, double sine, double from_s, double to_s) {
  Record record;
  for (double t = from_s; t < to_s; t += 0.01) {
    Sample sample{.time_s = t};
    sample.coordinate[3] =
        offset + cosine * std::cos(kFrequency_radps * t) + sine * std::sin(kFrequency_radps * t);
    record.push_back(sample);
  }
  return record;
}

TEST(SwingFit, FindsOffsetAndSwingOfAPendulum) {
  const auto fit = fit_swing(swinging(0.02, 0.03, -0.04, 5, 7), 3, kFrequency_radps);
  EXPECT_NEAR(fit.offset_rad, 0.02, 1e-12);
  EXPECT_NEAR(fit.cosine_rad, 0.03, 1e-12);
  EXPECT_NEAR(fit.sine_rad, -0.04, 1e-12);
  EXPECT_NEAR(fit.amplitude_rad(), 0.05, 1e-12);
  EXPECT_NEAR(fit.at(6.3, kFrequency_radps),
              0.02 + 0.03 * std::cos(kFrequency_radps * 6.3) - 0.04 * std::sin(kFrequency_radps * 6.3),
              1e-12);
}

/// Independent derivation: integration of the equation of the pendulum.
TEST(SwingFit, ExpectsTheSwingThatThePendulumEquationGives) {
  constexpr double kCable_m = 1.02, kStep_s = 1e-5;
  Record motion{Sample{}};
  double angle = 0, rate = 0, t = 0, position = 0;
  for (int tick = 1; tick <= 60; ++tick) {
    const double speed_mps = tick < 40 ? 0.002 * tick : 0;  // stops at once
    for (int i = 0; i < 1000; ++i, t += kStep_s) {
      rate -= kFrequency_radps * kFrequency_radps * angle * kStep_s;
      angle += (rate + speed_mps / kCable_m) * kStep_s;
      position += speed_mps * kStep_s;
    }
    motion.push_back({.time_s = t});
    motion.back().coordinate[0] = position;
  }
  const auto expected = expected_swing(motion, 0, 1, kCable_m, kFrequency_radps);
  EXPECT_NEAR(expected.at(t, kFrequency_radps), angle, 1e-5 + 1e-3 * expected.amplitude_rad());
  EXPECT_GT(expected.amplitude_rad(), 0.01);
}

TEST(SwingFit, SharesMeasureOnlyTheExpectedSwing) {
  const SwingFit before{0.01, 0.02, -0.01}, expected{0, 0.03, 0.04};
  EXPECT_NEAR(share_of(expected, before, {0.01, 0.05, 0.03}), 1, 1e-12);
  EXPECT_NEAR(share_of(expected, before, {0.01, -0.01, -0.05}), -1, 1e-12);
  EXPECT_NEAR(share_of(expected, before, before), 0, 1e-12);
  EXPECT_NEAR(share_of(expected, before, {0.01, 0.06, -0.04}), 0, 1e-12);  // a quarter period off
  EXPECT_EQ(share_of({}, before, expected), 0);
}

}  // namespace
}  // namespace crane::bring_up
