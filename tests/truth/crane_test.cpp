/// Compares the crane of the generator with closed forms.
#include "crane.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace truth {
namespace {

constexpr Disturbance kQuiet{.quantised = false};

Crane quiet(const Physics& physics, const Start& start = {}) { return {physics, kQuiet, start, 1, "test"}; }

Physics frictionless_tower() {
  Physics p = rig("tower");
  for (Drive& d : p.drive) d.coulomb_v = d.viscous_vs = {};
  return p;
}

/// Largest change of energy over ten seconds without command [J].
double drift_j(Crane crane) {
  const double before = crane.energy_j();
  double largest = 0;
  for (int i = 0; i < 1000; ++i) {
    crane.advance({});
    largest = std::max(largest, std::abs(crane.energy_j() - before));
  }
  return largest;
}

/// Tolerance, of 15 J; measured: 1e-13 J with one pendulum and 7e-13 J with two.
constexpr double kEnergy_j = 1e-10;

TEST(Truth, KeepsItsEnergyWithoutFriction) {
  Crane crane = quiet(frictionless_tower(),
                      {.trolley_m = 0.8, .slew_rad = 0.3, .radial_rad = 0.4, .tangential_rad = -0.3});
  crane.set_rate(kMotorSlew, 0.5);
  crane.set_rate(kMotorX, -0.05);
  EXPECT_LT(drift_j(crane), kEnergy_j);
}

TEST(Truth, KeepsItsEnergyAsADoublePendulum) {
  Physics p = frictionless_tower();
  p.hook_kg = 0.6, p.sling_m = 0.25;
  Crane crane = quiet(p, {.trolley_m = 0.8, .slew_rad = 0.3, .radial_rad = 0.4, .tangential_rad = -0.3});
  crane.set_rate(kMotorSlew, 0.5);
  crane.set_rate(kRadial2, 2);
  EXPECT_LT(drift_j(crane), kEnergy_j);
}

TEST(Truth, SwingsWithThePeriodOfAPendulumOfLargeAmplitude) {
  constexpr double kAmplitude_rad = 0.8;
  Crane crane = quiet(rig("pendulum"), {.radial_rad = kAmplitude_rad});
  const double period_s =
      4 * std::sqrt(1 / 9.81) * std::comp_ellint_1(std::sin(kAmplitude_rad / 2));  // period with L = 1 m
  double before = 0, crossing_s = 0;
  for (int k = 1; crossing_s == 0; ++k) {
    before = crane.sense()[2];
    crane.advance({});
    if (before < 0 && crane.sense()[2] >= 0)
      crossing_s = (k - 1 + before / (before - crane.sense()[2])) * kTick_s;
  }
  // error of the linear interpolation between ticks of 0.01 s at a zero crossing
  EXPECT_NEAR(crossing_s, 0.75 * period_s, 1e-5);
}

/// Small swings of two masses on one line: w^4 m1 L1 L2 - w^2 (m1 + m2) g (L1 + L2) + (m1 + m2) g^2 = 0.
TEST(Truth, SwingsAsADoublePendulumInItsFastMode) {
  constexpr double kSmall_rad = 1e-4;
  Physics p = rig("pendulum");
  p.hook_kg = 0.6, p.sling_m = 0.25;
  const double m1 = 0.6, m = 2, l1 = 0.75, l2 = 0.25, g = 9.81;
  const double sum = m * g * (l1 + l2), root = std::sqrt(sum * sum - 4 * m1 * l1 * l2 * m * g * g);
  const double omega = std::sqrt((sum + root) / (2 * m1 * l1 * l2));
  // From the second equation, L1 a1 w^2 + L2 a2 w^2 = g a2: ratio of the two amplitudes.
  const double ratio = l1 * omega * omega / (g - l2 * omega * omega);
  Crane crane = quiet(p);
  crane.set_rate(kRadial, kSmall_rad * omega);
  crane.set_rate(kRadial2, kSmall_rad * omega * ratio);
  for (int k = 0; k < 100; ++k) {
    EXPECT_NEAR(crane.sense()[2], kSmall_rad * std::sin(omega * k * kTick_s), 1e-8);
    crane.advance({});
  }
}

TEST(Truth, SticksBelowItsFrictionAndSlidesAboveIt) {
  Physics p = rig("drive_axis");
  Crane below = quiet(p), above = quiet(p);
  for (int i = 0; i < 1000; ++i) {
    below.advance({std::min(0.95, 0.01 * i), 0});
    above.advance({1.2, 0});
  }
  // While the bristles deflect, z' = x' (1 - z / z_c), hence x = -z_c ln(1 - V/c). Every step of the voltage
  // adds a small overshoot.
  const double slid = p.drive[0].presliding * 1.0 / 1.1, expected = -slid * std::log(1 - 0.95 / 1.0);
  EXPECT_NEAR(below.sense()[0], expected, 0.1 * expected);
  EXPECT_LT(std::abs(below.rate()[kMotorX]), 1e-9);
  // Steady speed (V - c) / b after 10 s, time constant 1 / (b K) = 0.2 s.
  EXPECT_NEAR(above.rate()[kMotorX], (1.2 - 1.0) / 2.8, 1e-4);
}

TEST(Truth, DelaysTheCommandToTheMicrosecond) {
  constexpr double kDelay_s = 0.0123, kEnd_s = 0.5;
  Physics p = rig("gantry");
  p.load_kg = 0, p.radial = false;
  p.drive[0].delay_s = kDelay_s;
  Crane crane = quiet(p);
  for (int i = 0; i < 50; ++i) crane.advance({1, 0});
  const double driven_s = kEnd_s - kDelay_s;
  EXPECT_NEAR(crane.sense()[0], 0.5 * 1.2 * driven_s * driven_s, 1e-9);
}

TEST(Truth, CrossesAGapBeforeTheCarriageFollows) {
  Physics p = frictionless_tower();
  p.load_kg = 0, p.radial = p.tangential = false;
  p.drive[0].gap = 0.01;
  Crane crane = quiet(p, {.trolley_m = 0.5});
  for (int i = 0; i < 200; ++i) {
    crane.advance({0.5, 0});
    const double apart = crane.position()[kMotorX] - crane.position()[kCarriage];
    if (crane.position()[kMotorX] < 0.505) {
      EXPECT_EQ(crane.position()[kCarriage], 0.5);
    }
    EXPECT_LT(std::abs(apart), 0.005 + 0.001);  // half the gap plus the deflection of the contact
  }
  EXPECT_GT(crane.position()[kCarriage], 0.6);
}

TEST(Truth, TwistsAtTheFrequencyOfTwoInertias) {
  Physics p = frictionless_tower();
  p.load_kg = 0, p.radial = p.tangential = false;
  p.drive[1].stiffness = 800;
  Crane crane = quiet(p);  // the trolley is at the tower axis
  crane.set_rate(kMotorSlew, 0.1);
  const double motor = 0.35 * 7.2, jib = 0.65 * 7.2;
  const double omega = std::sqrt(800 * (1 / motor + 1 / jib));
  double before = 0, crossing_s = 0;
  for (int k = 1; crossing_s == 0; ++k) {
    crane.advance({});
    const double twist = crane.position()[kMotorSlew] - crane.position()[kJib];
    if (before > 0 && twist <= 0) crossing_s = (k - 1 + before / (before - twist)) * kTick_s;
    before = twist;
  }
  EXPECT_NEAR(crossing_s, std::numbers::pi / omega,
              2e-3 * std::numbers::pi / omega);  // tolerance for a damping ratio of 3 to 6 %
}

TEST(Truth, StretchesTheCableByTheLoadsWeight) {
  Physics p = rig("pendulum");
  p.cable_stiffness_n = 500;
  Crane crane = quiet(p);
  for (int i = 0; i < 500; ++i) crane.advance({});
  EXPECT_NEAR(crane.position()[kCable], 1 + 2 * 9.81 / 500, 1e-9);
}

}  // namespace
}  // namespace truth
