/// Moves an undamped linear load, phi'' + w^2 phi = x''/L, with shaped references and compares the residual
/// swing with the formulas and insensitivities of Singer, Seering and Singhose.
#include "crane/control/shaper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "crane/control/trajectory.hpp"

namespace crane::control {
namespace {

using std::numbers::pi;
constexpr double kPeriod_s = 2;  ///< load period for which the shapers are designed

/// Amplitude after the reference is at rest, for a load with `ratio` times the frequency and L = 1 m.
double swing_left(const Shaper& shaper, const AxisProfile& profile, double ratio) {
  const double w = 2 * pi * ratio / kPeriod_s, end_s = profile.duration_s() + shaper.delay_s();
  const int steps = 20000;
  const double h = end_s / steps;
  double swing = 0, rate = 0;
  for (int k = 0; k < steps; ++k) {  // leapfrog, with the acceleration in the middle of the step
    swing += h / 2 * rate;
    rate += h * (shaper.at(profile, (k + 0.5) * h).acceleration - w * w * swing);
    swing += h / 2 * rate;
  }
  return std::hypot(swing, rate / w);
}

/// Residual swing relative to the unshaped profile, whose short ramp excites the swing at all ratios.
double share_left(Shaping shaping, double ratio) {
  const AxisProfile profile = timed_profile(0, 0.5, 0.45, 0.15, 0.03);
  return swing_left({shaping, kPeriod_s}, profile, ratio) / swing_left({}, profile, ratio);
}

double expected_share(Shaping shaping, double ratio) {
  if (shaping == Shaping::zv) return std::abs(std::cos(pi * ratio / 2));
  if (shaping == Shaping::zvd) return std::pow(std::cos(pi * ratio / 2), 2);
  return std::abs(1.05 / 2 * std::cos(pi * ratio) + 0.95 / 2);
}

constexpr double kIntegration = 1e-3;  // of 20000 steps over jumps of the acceleration

TEST(Shapers, LeaveTheTheoreticalSwingAtAndBesideTheirDesignFrequency) {
  for (const Shaping shaping : {Shaping::zv, Shaping::zvd, Shaping::ei})
    for (const double ratio : {0.5, 0.7, 0.8, 0.9, 0.97, 1.0, 1.03, 1.1, 1.2, 1.3, 1.5})
      EXPECT_NEAR(share_left(shaping, ratio), expected_share(shaping, ratio), kIntegration)
          << static_cast<int>(shaping) << " at " << ratio;
}

TEST(Shapers, LeaveNoSwingAtTheirDesignFrequencyExceptEiWithFivePercent) {
  EXPECT_NEAR(share_left(Shaping::zv, 1), 0, kIntegration);
  EXPECT_NEAR(share_left(Shaping::zvd, 1), 0, kIntegration);
  EXPECT_NEAR(share_left(Shaping::ei, 1), 0.05, kIntegration);
  EXPECT_NEAR(share_left(Shaping::none, 1), 1, 1e-12);
}

/// Width of the band of f T around 1 with at most 5 % residual swing.
double insensitivity(Shaping shaping) {
  const auto edge = [shaping](double inside, double outside) {
    for (int k = 0; k < 30; ++k) {
      const double middle = (inside + outside) / 2;
      (share_left(shaping, middle) <= 0.05 + 1e-4 ? inside : outside) = middle;
    }
    return inside;
  };
  // The residual swing of ei is 5 % in the middle: the search starts at one of its zeros.
  const double zero = shaping == Shaping::ei ? std::acos(-0.95 / 1.05) / pi : 1;
  return edge(2 - zero, 1.5) - edge(zero, 0.5);
}

TEST(Shapers, HaveTheInsensitivityOfTheLiterature) {
  EXPECT_NEAR(insensitivity(Shaping::zv), 0.06, 0.005);  // the source prints two digits
  EXPECT_NEAR(insensitivity(Shaping::zvd), 0.29, 0.005);
  EXPECT_NEAR(insensitivity(Shaping::ei), 0.40, 0.005);
}

TEST(Shapers, BeginAndEndExactlyAtTheEndsOfTheirProfile) {
  const AxisProfile profile = limited_profile(0.3, 1.05, {0.5, 1, 10});
  for (const Shaping shaping : {Shaping::none, Shaping::zv, Shaping::zvd, Shaping::ei}) {
    const Shaper shaper(shaping, kPeriod_s);
    const double end_s = profile.duration_s() + shaper.delay_s();
    EXPECT_EQ(shaper.at(profile, -1).position, 0.3);
    for (const double t : {end_s + 1e-9, end_s + 1, 1e9}) {
      EXPECT_EQ(shaper.at(profile, t).position, 1.05);
      EXPECT_EQ(shaper.at(profile, t).speed, 0);
      EXPECT_EQ(shaper.at(profile, t).acceleration, 0);
    }
  }
}

TEST(Shapers, KeepTheLimitsOfTheirProfile) {
  const AxisProfile profile = limited_profile(0, 2, {0.5, 1, 5});
  for (const Shaping shaping : {Shaping::zv, Shaping::zvd, Shaping::ei}) {
    const Shaper shaper(shaping, kPeriod_s);
    for (double t = 0; t < profile.duration_s() + shaper.delay_s(); t += 0.01) {
      EXPECT_LE(std::abs(shaper.at(profile, t).speed), 0.5 * (1 + 1e-12));
      EXPECT_LE(std::abs(shaper.at(profile, t).acceleration), 1 + 1e-12);
    }
  }
}

TEST(Shapers, ConvertAStepIntoAStaircase) {
  const AxisProfile step = step_profile(0, 1);
  const Shaper shaper(Shaping::zvd, kPeriod_s);
  EXPECT_EQ(shaper.at(step, 0.5).position, 0.25);
  EXPECT_EQ(shaper.at(step, 1.5).position, 0.75);
  EXPECT_EQ(shaper.at(step, 2).position, 1);
}

TEST(Shapers, LengthenTheMoveByHalfAPeriodOrAPeriod) {
  EXPECT_EQ(Shaper().delay_s(), 0);
  EXPECT_EQ(Shaper(Shaping::zv, kPeriod_s).delay_s(), kPeriod_s / 2);
  EXPECT_EQ(Shaper(Shaping::zvd, kPeriod_s).delay_s(), kPeriod_s);
  EXPECT_EQ(Shaper(Shaping::ei, kPeriod_s).delay_s(), kPeriod_s);
}

TEST(Shapers, RefuseAnInvalidPeriod) {
  for (const double period_s : {0.0, -1.0, 1e300, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)Shaper(Shaping::zv, period_s), std::invalid_argument) << period_s;
  try {
    (void)Shaper(Shaping::ei, -2);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "load_period_s = -2: must be in (0, 1e+06]");
  }
}

}  // namespace
}  // namespace crane::control
