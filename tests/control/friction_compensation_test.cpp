#include "crane/control/friction_compensation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace crane::control {
namespace {

DriveFriction trolley_friction() {
  DriveFriction f;
  f.viscous_positive_vspm = 1.5, f.viscous_negative_vspm = 6;
  f.coulomb_positive_v = 0.9, f.coulomb_negative_v = 1.2;
  f.stiction_positive_v = 1.0, f.stiction_negative_v = 1.4;
  f.factor = 1;
  return f;
}

TEST(FrictionCompensation, CancelsTheModelFrictionOutsideTheZeroBand) {
  // Oracle: (3.16) with corrected signs, v' = K_m u + (-c+ - b+ v) or + (c- - b- v), all over K_m.
  const auto f = trolley_friction();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> speeds(-1, 1), controls(-10, 10);
  for (int trial = 0; trial < 1000; ++trial) {
    const double v = speeds(random), control = controls(random);
    if (std::abs(v) <= f.zero_band_mps) continue;
    const double friction_v = v > 0 ? -0.9 - 1.5 * v : 1.2 - 6 * v;
    EXPECT_NEAR(friction_compensation_v(f, control, v) + friction_v, 0, 1e-14);
  }
}

TEST(FrictionCompensation, AddsUpToTheStictionOfTheDirectionAtRest) {
  const auto f = trolley_friction();
  EXPECT_NEAR(friction_compensation_v(f, 5, 0), 1.0, 1e-12);
  EXPECT_NEAR(friction_compensation_v(f, -5, 0.004), -1.4, 1e-12);
  EXPECT_NEAR(friction_compensation_v(f, 0.01, 0), std::tanh(1.0), 1e-12);
}

TEST(FrictionCompensation, GivesZeroVoltsAtStandstillForZeroControlVoltage) {
  EXPECT_EQ(friction_compensation_v(trolley_friction(), 0, 0), 0);
}

TEST(FrictionCompensation, RisesWithTheDemandWithoutAStep) {
  const auto f = trolley_friction();
  for (double control = -0.1; control < 0.1; control += 1e-4) {
    const double rise =
        friction_compensation_v(f, control + 1e-4, 0) - friction_compensation_v(f, control, 0);
    EXPECT_GE(rise, 0);
    EXPECT_LE(rise, 1.4 * 100 * 1e-4 * 1.0001);  // steepest slope: f_s- A
  }
}

TEST(FrictionCompensation, MultipliesTheFrictionByItsFactor) {
  auto f = trolley_friction();
  const double whole = friction_compensation_v(f, 3, 0.2);
  f.factor = 0.8;
  EXPECT_DOUBLE_EQ(friction_compensation_v(f, 3, 0.2), 0.8 * whole);
  f.factor = 0;
  EXPECT_EQ(friction_compensation_v(f, 3, 0.2), 0);
}

TEST(FrictionCompensation, IsFiniteForEveryFiniteInput) {
  const auto f = trolley_friction();
  const double most = std::numeric_limits<double>::max();
  for (const double control : {-most, -1.0, 0.0, 1.0, most})
    for (const double speed : {-most, -1.0, 0.0, 1.0, most})
      EXPECT_TRUE(std::isfinite(friction_compensation_v(f, control, speed)));
}

}  // namespace
}  // namespace crane::control
