#include "crane/control/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace crane::control {
namespace {

constexpr double kPrintedDigits = 5e-5;

TEST(TimedProfile, HasThePrintedSpeedsAndAccelerations) {  // (3.54), (3.55)
  const double period_s = 2 * std::numbers::pi * std::sqrt(1 / 9.8);
  const auto trolley = timed_profile(0.25, 1.0, period_s, period_s / 4);
  EXPECT_NEAR(trolley.speed, 0.4982, kPrintedDigits);
  EXPECT_NEAR(trolley.acceleration, 0.9929, kPrintedDigits);
  const auto slew = timed_profile(0, std::numbers::pi / 2, period_s, period_s / 4);
  EXPECT_NEAR(slew.speed, 1.0435, kPrintedDigits);
  EXPECT_NEAR(slew.acceleration, 2.0796, kPrintedDigits);
}

TEST(LimitedProfile, TakesDistanceOverSpeedPlusSpeedOverAcceleration) {  // (3.43)
  const auto profile = limited_profile(0, 0.75, {0.4982, 0.9929});
  EXPECT_NEAR(profile.duration_s(), 0.75 / 0.4982 + 0.4982 / 0.9929, 1e-12);
}

TEST(LimitedProfile, IsATriangleWhenTheMoveIsTooShortForFullSpeed) {
  const auto profile = limited_profile(1, 0.9, {1, 1});
  EXPECT_EQ(profile.coast_s, 0);
  EXPECT_NEAR(profile.duration_s(), 2 * std::sqrt(0.1), 1e-12);
  EXPECT_NEAR(std::abs(profile.speed), std::sqrt(0.1), 1e-12);
}

void expect_sound(const AxisProfile& profile, const AxisLimits& limits) {
  const double size = 1 + std::abs(profile.start) + std::abs(profile.target);
  const double duration = profile.duration_s(), tick = duration / 997;
  EXPECT_EQ(profile.at(-1).position, profile.start);
  EXPECT_NEAR(profile.at(0).position, profile.start, 1e-12 * size);
  EXPECT_EQ(profile.at(duration).position, profile.target);
  EXPECT_EQ(profile.at(duration).speed, 0);
  const auto before_end = profile.at(duration * (1 - 1e-12));
  EXPECT_NEAR(before_end.position, profile.target, 1e-9 * size);
  for (double t = 0; t < duration - tick; t += tick) {
    const auto now = profile.at(t), next = profile.at(t + tick);
    EXPECT_LE(std::abs(now.speed), limits.speed * (1 + 1e-12));
    EXPECT_LE(std::abs(now.acceleration), limits.acceleration * (1 + 1e-12));
    // Position and speed are continuous: the limits bound their change per tick.
    EXPECT_LE(std::abs(next.position - now.position), limits.speed * tick + 1e-12 * size);
    EXPECT_LE(std::abs(next.speed - now.speed), limits.acceleration * tick * (1 + 1e-9) + 1e-12);
    // The speed is the derivative of the position.
    EXPECT_NEAR((next.position - now.position) / tick, (now.speed + next.speed) / 2,
                limits.acceleration * tick + 1e-9 * size / duration);
  }
}

TEST(LimitedProfile, ArrivesWithoutEverLeavingItsLimits) {
  std::mt19937 random(42);
  std::uniform_real_distribution<double> place(-2, 2), exponent(-2, 1);
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(testing::Message() << "seed 42 trial " << trial);
    const AxisLimits limits{std::pow(10, exponent(random)), std::pow(10, exponent(random))};
    expect_sound(limited_profile(place(random), place(random), limits), limits);
  }
}

TEST(Trajectory, EndsOnAllAxesAtTheSameTimeWithinLimits) {
  const AxisLimits trolley{0.5, 1}, slew{1, 2}, hoist{0.1, 0.2};
  Trajectory own{limited_profile(0.3, 1.05, trolley), limited_profile(0, -1.57, slew),
                 limited_profile(1, 1, hoist)};
  const Trajectory together = synchronised(own);
  EXPECT_DOUBLE_EQ(duration_s(together), duration_s(own));
  EXPECT_NEAR(together[kTrolley].duration_s(), together[kSlew].duration_s(), 1e-12);
  EXPECT_EQ(together[kHoist].duration_s(), 0) << "an axis that stays has nothing to stretch";
  expect_sound(together[kTrolley], trolley);
  expect_sound(together[kSlew], slew);
  const Reference end = reference_at(together, duration_s(together) + 1e-9);
  EXPECT_EQ(end[kTrolley].position, 1.05);
  EXPECT_EQ(end[kSlew].position, -1.57);
  EXPECT_EQ(end[kHoist].position, 1);
}

TEST(StepProfile, IsAtItsTargetFromTimeZeroOn) {
  const auto profile = step_profile(0.3, 1.05);
  EXPECT_EQ(profile.at(-1e-9).position, 0.3);
  EXPECT_EQ(profile.at(0).position, 1.05);
  EXPECT_EQ(profile.at(0).speed, 0);
}

TEST(LimitedProfile, StandsStillWhenTheStartIsTheTarget) {
  const auto profile = limited_profile(0.4, 0.4, {1, 1});
  EXPECT_EQ(profile.duration_s(), 0);
  EXPECT_EQ(profile.at(0).position, 0.4);
}

TEST(LimitedProfile, RefusesInvalidLimits) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)limited_profile(0, 1, {0, 1}), std::invalid_argument);
  EXPECT_THROW((void)limited_profile(0, 1, {1, -1}), std::invalid_argument);
  EXPECT_THROW((void)limited_profile(0, nan, {1, 1}), std::invalid_argument);
  try {
    (void)limited_profile(nan, 1, {0, 1});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "start = nan: must be in [-1e+09, 1e+09]; speed = 0: must be in [1e-09, 1e+09]");
  }
}

TEST(TimedProfile, RefusesRampsLongerThanHalfTheMove) {
  EXPECT_THROW((void)timed_profile(0, 1, 1, 0.6), std::invalid_argument);
  EXPECT_THROW((void)timed_profile(0, 1, 1, 0), std::invalid_argument);
  EXPECT_EQ(timed_profile(0, 1, 1, 0.5).coast_s, 0);
}

}  // namespace
}  // namespace crane::control
