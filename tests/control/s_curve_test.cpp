#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "crane/control/trajectory.hpp"

namespace crane::control {
namespace {

/// Checks that the profile keeps its limits, that position, speed and acceleration are continuous, and that
/// speed and acceleration are derivatives of position and speed.
void expect_smooth(const AxisProfile& profile, const AxisLimits& limits) {
  const double duration_s = profile.duration_s(), tick_s = duration_s / 1009;
  const double size = 1 + std::abs(profile.start) + std::abs(profile.target);
  const double slack = 1e-11;  // rounding error of positions of this size
  for (double t = 0; t < duration_s - tick_s; t += tick_s) {
    const auto now = profile.at(t), next = profile.at(t + tick_s);
    EXPECT_LE(std::abs(now.speed), limits.speed * (1 + slack));
    EXPECT_LE(std::abs(now.acceleration), limits.acceleration * (1 + slack));
    EXPECT_LE(std::abs(next.acceleration - now.acceleration),
              limits.jerk * tick_s * (1 + 1e-6) + slack * limits.acceleration);
    EXPECT_NEAR((next.speed - now.speed) / tick_s, (now.acceleration + next.acceleration) / 2,
                limits.jerk * tick_s + slack * limits.speed / tick_s);
    EXPECT_NEAR((next.position - now.position) / tick_s, (now.speed + next.speed) / 2,
                limits.acceleration * tick_s + slack * size / tick_s);
  }
  EXPECT_EQ(profile.at(0).position, profile.start);
  EXPECT_EQ(profile.at(duration_s).position, profile.target);
  EXPECT_NEAR(profile.at(duration_s * (1 - 1e-9)).position, profile.target, 1e-7 * size);
  const auto before = profile.at(duration_s / 2 * (1 - 1e-12)),
             after = profile.at(duration_s / 2 * (1 + 1e-12));
  EXPECT_NEAR(before.position, after.position, 1e-9 * size);
  EXPECT_NEAR(before.speed, after.speed, 1e-9 * (1 + limits.speed));
}

TEST(SCurve, ArrivesWithinItsLimitsAndUsesTheWholeJerk) {
  const unsigned seed = 42;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-2, 2), exponent(-2, 1);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << " trial " << trial);
    const AxisLimits limits{std::pow(10, exponent(random)), std::pow(10, exponent(random)),
                            std::pow(10, exponent(random))};
    const auto profile = limited_profile(place(random), place(random), limits);
    expect_smooth(profile, limits);
    // No faster profile exists: the jerk is always at its limit; acceleration and speed reach their limits
    // unless the move is too short.
    EXPECT_NEAR(std::abs(profile.acceleration) / profile.jerk_s, limits.jerk, 1e-9 * limits.jerk);
    if (profile.coast_s > 0) {
      EXPECT_NEAR(std::abs(profile.speed), limits.speed, 1e-9 * limits.speed);
    }
    if (profile.ramp_s > 2 * profile.jerk_s * (1 + 1e-9)) {
      EXPECT_NEAR(std::abs(profile.acceleration), limits.acceleration, 1e-9 * limits.acceleration);
    }
  }
}

TEST(SCurve, TakesTheTimesOfItsThreeCases) {
  // Three cases: V_max is reached, Z/V + V/a + a/j; only a_max is reached; neither is reached, 4 cbrt(Z/(2
  // j)).
  EXPECT_NEAR(limited_profile(0, 3, {1, 2, 8}).duration_s(), 3.0 + 0.5 + 0.25, 1e-12);
  EXPECT_NEAR(limited_profile(0, 0.5, {1, 2, 8}).duration_s(), 0.25 + std::sqrt(0.0625 + 1), 1e-12);
  EXPECT_NEAR(limited_profile(0, -0.01, {1, 2, 8}).duration_s(), 4 * std::cbrt(0.01 / 16), 1e-12);
  // The profile reaches V_max before a_max.
  EXPECT_NEAR(limited_profile(0, 3, {0.1, 2, 8}).duration_s(), 30 + 2 * std::sqrt(0.1 / 8), 1e-12);
}

TEST(SCurve, BecomesBangCoastBangWithoutJerkLimit) {
  const auto bang = limited_profile(0.3, 1.05, {0.5, 1}), almost = limited_profile(0.3, 1.05, {0.5, 1, 1e9});
  EXPECT_EQ(bang.jerk_s, 0);
  for (double t = 0; t < 2.5; t += 0.01) EXPECT_NEAR(bang.at(t).position, almost.at(t).position, 1e-8);
}

TEST(SCurve, IsTheRunningMeanOfBangCoastBangOverItsJerkTime) {
  // Independent derivation: an S-curve is the bang-coast-bang profile without jerk phases, averaged over the
  // jerk time.
  const auto curve = limited_profile(0, 3, {1, 2, 8});
  const auto bang = limited_profile(0, 3, {1, 2});
  const int points = 2000;
  for (double t = 0; t < curve.duration_s(); t += 0.05) {
    double mean = 0;
    for (int i = 0; i < points; ++i) mean += bang.at(t - 0.25 * (i + 0.5) / points).position / points;
    EXPECT_NEAR(curve.at(t).position, mean, 1e-7) << t;  // midpoint rule
  }
}

TEST(SCurve, KeepsAGivenFinalTime) {
  const auto profile = timed_profile(0.25, 1, 2, 0.5, 0.2);
  EXPECT_EQ(profile.duration_s(), 2);
  EXPECT_NEAR(profile.speed, 0.75 / 1.5, 1e-15);
  EXPECT_NEAR(profile.acceleration, 0.5 / 0.3, 1e-15);
  expect_smooth(profile, {0.5, 0.5 / 0.3, 0.5 / 0.3 / 0.2});
  const AxisLimits limits{0.5, 1, 10};
  const auto own = limited_profile(0.25, 1, limits);
  const auto later = stretched(own, 4);
  EXPECT_NEAR(later.duration_s(), 4, 1e-12);
  expect_smooth(later, limits);
}

TEST(SCurve, RefusesInvalidLimitsAndTimesByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double jerk : {0.0, -1.0, nan, -std::numeric_limits<double>::infinity()})
    EXPECT_THROW((void)limited_profile(0, 1, {1, 1, jerk}), std::invalid_argument) << jerk;
  EXPECT_THROW((void)timed_profile(0, 1, 1, 0.4, 0.21), std::invalid_argument);
  EXPECT_THROW((void)timed_profile(0, 1, 1, 0.4, -0.1), std::invalid_argument);
  try {
    (void)limited_profile(0, 1, {1, 1, -2});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "jerk = -2: must be in [1e-09, 1e+09]");
  }
}

TEST(EveryTrajectory, IsFiniteOrRefusedForAnyFiniteInput) {
  const unsigned seed = 271;
  std::mt19937 random(seed);
  constexpr std::array kSizes{0.0, 5e-324, 1e-300, 1e-9, 1e-3, 0.5, 1.0, 30.0, 1e9, 1e300, 1.7e308};
  const auto any = [&] {
    return kSizes[std::uniform_int_distribution<std::size_t>(0, kSizes.size() - 1)(random)];
  };
  const auto finite = [](const AxisReference& r) {
    return std::isfinite(r.position) && std::isfinite(r.speed) && std::isfinite(r.acceleration);
  };
  int refused = 0, planned = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    try {
      const double start = -any(), target = any(), first = any(), second = any(), third = any();
      const bool timed = trial % 2 == 0;
      const auto profile = timed ? timed_profile(start, target, first, second, third)
                                 : limited_profile(start, target, {first, second, third});
      const auto slower = stretched(profile, 3 * profile.duration_s());
      for (const double share : {-1.0, 0.0, 1e-9, 0.1, 0.3, 0.5, 0.7, 1.0, 2.0})
        ASSERT_TRUE(finite(profile.at(share * profile.duration_s())) &&
                    finite(slower.at(share * slower.duration_s())))
            << "seed " << seed << " trial " << trial;
      ++planned;
    } catch (const std::invalid_argument&) {
      ++refused;
    }
  }
  EXPECT_GT(planned, 100);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace crane::control
