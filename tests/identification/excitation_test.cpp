/// References of the experiment: smooth, within the limits of the rig, with a limited swing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "crane/identification/excitation_design.hpp"

namespace crane::identification {
namespace {

using control::Excitation;

constexpr ExcitationLimits kRoomy{.low = -5, .high = 5, .speed = 100, .swing_rad = 0, .load = {}};

TEST(Excitation, HasSpeedAndAccelerationOfItsPosition) {
  const Excitation excitation = multi_sine(control::kTrolley, kTrolleyAmplitude_m, kRoomy, 20);
  constexpr double kH = 1e-4;
  for (double t = 0.05; t < 20; t += 0.37) {
    const auto before = excitation.at(t - kH), now = excitation.at(t), after = excitation.at(t + kH);
    EXPECT_NEAR(now.speed, (after.position - before.position) / (2 * kH), 1e-6) << t;
    EXPECT_NEAR(now.acceleration, (after.speed - before.speed) / (2 * kH), 1e-6) << t;
  }
}

TEST(Excitation, BeginsAndEndsAtRest) {
  const Excitation excitation = multi_sine(control::kTrolley, kTrolleyAmplitude_m, kRoomy, 20);
  for (const double t : {-1.0, 0.0, 20.0, 25.0}) {
    EXPECT_EQ(excitation.at(t).position, excitation.mean_position);
    EXPECT_EQ(excitation.at(t).speed, 0);
  }
  EXPECT_NEAR(excitation.at(1e-6).speed, 0, 1e-5);
  EXPECT_NEAR(excitation.at(20 - 1e-6).speed, 0, 1e-5);
}

TEST(Excitation, IsTheDissertationsBetweenItsFades) {
  const Excitation excitation = multi_sine(control::kTrolley, kTrolleyAmplitude_m, kRoomy, 20);
  using std::numbers::pi;
  for (double t = Excitation::kFade_s; t < 20 - Excitation::kFade_s; t += 0.1)  // (4.11)
    EXPECT_NEAR(excitation.at(t).position,
                0.6 * (-0.4 * std::sin(2 * pi / 3 * t) + 0.3 * std::sin(2 * pi / 4 * t)), 1e-12);
}

TEST(Excitation, WithoutSinesIsAStep) {
  const Excitation step{.axis = control::kSlew, .mean_position = 0.4, .sines = {}, .duration_s = 3};
  for (const double t : {0.0, 1.0, 5.0}) EXPECT_EQ(step.at(t).position, 0.4);
  EXPECT_EQ(step.at(1).speed, 0);
}

TEST(MultiSine, KeepsTravelAndSpeed) {
  const Excitation narrow = multi_sine(control::kSlew, kSlewAmplitude_rad,
                                       {.low = 1, .high = 1.2, .speed = 100, .swing_rad = 0, .load = {}}, 60);
  const Excitation slow = multi_sine(control::kSlew, kSlewAmplitude_rad,
                                     {.low = -5, .high = 5, .speed = 0.3, .swing_rad = 0, .load = {}}, 60);
  for (double t = 0; t < 60; t += 0.01) {
    EXPECT_GE(narrow.at(t).position, 1);
    EXPECT_LE(narrow.at(t).position, 1.2);
    const bool faded = t > Excitation::kFade_s && t < 60 - Excitation::kFade_s;
    EXPECT_TRUE(!faded || std::abs(slow.at(t).speed) <= 0.3 + 1e-12) << t;
  }
}

TEST(MultiSine, KeepsTheSwing) {
  for (const auto& radius_m : {std::optional<double>{}, std::optional<double>{0.19}}) {
    const ExcitationLimits limits{.low = -5,
                                  .high = 5,
                                  .speed = 100,
                                  .swing_rad = 0.1,
                                  .load = {.cable_m = 1, .gravity_mps2 = 9.81, .radius_m = radius_m}};
    const Excitation excitation = multi_sine(radius_m ? control::kSlew : control::kTrolley, 2, limits, 60);
    const double swing_rad = predicted_swing_rad(excitation, limits.load);
    EXPECT_LE(swing_rad, 0.1);
    EXPECT_GT(swing_rad, 0.08);
  }
}

TEST(PredictedSwing, OfASlowTrolleyIsQuasiStatic) {
  Excitation slow{.axis = control::kTrolley, .mean_position = 0.5, .sines = {}, .duration_s = 120};
  slow.sines[0] = {0.3, 0.02, 0};
  // a/g at the largest acceleration of the sine between its fades. The fades last longer than a period of the
  // load.
  double largest = 0;
  for (double t = 0; t < 120; t += 0.01) largest = std::max(largest, std::abs(slow.at(t).acceleration));
  const double swing_rad = predicted_swing_rad(slow, {.cable_m = 1, .gravity_mps2 = 9.81, .radius_m = {}});
  EXPECT_GT(swing_rad, 0.9 * largest / 9.81);
  EXPECT_LT(swing_rad, 2 * largest / 9.81);
}

TEST(PredictedSwing, OfASlightlyTurningJibIsThatOfATrolleyAtItsRadius) {
  const Excitation turning = multi_sine(control::kSlew, 0.01, kRoomy, 60);
  Excitation moving = turning;
  for (control::Sine& sine : moving.sines) sine.amplitude *= 0.8;
  const double expected = predicted_swing_rad(moving, {.cable_m = 1.2, .gravity_mps2 = 9.81, .radius_m = {}});
  EXPECT_NEAR(predicted_swing_rad(turning, {.cable_m = 1.2, .gravity_mps2 = 9.81, .radius_m = 0.8}), expected,
              0.01 * expected);
}

TEST(BreakAwaySine, RaisesTheVoltageSlowlyAndFarEnough) {
  const Excitation slow = break_away_sine(control::kTrolley, kRoomy, 12, 0.4, 2.1, 4);
  double fastest = 0, low = 1e9, high = -1e9;
  for (double t = 0; t < slow.duration_s; t += 0.01) {
    const auto at = slow.at(t);
    if (t > Excitation::kFade_s && t < slow.duration_s - Excitation::kFade_s)
      fastest = std::max(fastest, std::abs(at.speed));
    low = std::min(low, at.position);
    high = std::max(high, at.position);
  }
  EXPECT_NEAR(12 * fastest, 0.4, 1e-3);
  EXPECT_GT(12 * (high - low), 1.9 * 2.1);
}

TEST(BreakAwaySine, NeedsTravel) {
  EXPECT_THROW(
      (void)break_away_sine(control::kTrolley,
                            {.low = 0, .high = 0.1, .speed = 1, .swing_rad = 0, .load = {}}, 12, 0.4, 2.1, 4),
      std::invalid_argument);
}

}  // namespace
}  // namespace crane::identification
