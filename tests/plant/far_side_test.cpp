#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "structure_motion.hpp"

namespace crane::plant {
namespace {

using test::held;
using test::StructureMotion;

constexpr double kGap_m = 0.004;
constexpr double kContact_radps = 2 * std::numbers::pi * 25;
constexpr double kFine_s = 0.001;
Model with_backlash(double guide = 1) {
  return Model{{}, {{"backlash", "trolley", {{"gap", kGap_m}, {"guide_deceleration", guide}}}}};
}

TEST(Backlash, KeepsTheTrolleyAtRestWhileTheMotorCrossesTheGap) {
  const Model model = with_backlash();
  StructureMotion motion{{.trolley_m = 0.5, .trolley_mps = 0.1}};
  const auto run = [&](double acceleration, double seconds) {
    for (long left = std::lround(seconds / kFine_s); left > 0; --left)
      motion = test::step(model, motion, held({acceleration, 0, 0}), kFine_s);
  };
  run(0, 1);  // the motor pushes from behind: b = -h/2 minus the deflection of the contact by friction
  EXPECT_NEAR(motion.inner[0].position, -kGap_m / 2 - 1 / std::pow(kContact_radps, 2), 1e-6);
  EXPECT_NEAR(motion.inner[0].rate, 0, 1e-6);
  run(-0.5, 0.2);  // the deceleration is smaller than that by friction: the flanks remain in contact
  EXPECT_LT(motion.inner[0].position, -kGap_m / 2);
  run(-0.1, 0.15);  // the motor reverses and moves back by 1.1 mm
  const double moved = motion.state.trolley_mps + motion.inner[0].rate;
  EXPECT_LT(motion.state.trolley_mps, -0.01);
  EXPECT_NEAR(moved, 0, 1e-4);
  run(0, 1);  // the other flank drives the load side
  EXPECT_NEAR(motion.inner[0].position, kGap_m / 2 + 1 / std::pow(kContact_radps, 2), 1e-6);
}

TEST(Backlash, DoesNotTransmitTheMotorToTheLoadInsideTheGap) {
  InnerAccelerations own{};
  const Accelerations a = with_backlash().accelerations({.trolley_m = 0.5}, held({2, 0, 0}), {}, own);
  EXPECT_EQ(own[0], -2);
  EXPECT_NEAR(a.radial_radps2, 0, 1e-12);  // without the gap, x'' / L would be 2
}

TEST(Backlash, TurningJibThrowsTheTrolleyOutwardThroughTheGap) {
  InnerAccelerations own{};
  (void)with_backlash(0).accelerations({.trolley_m = 0.5, .slew_radps = 0.8}, held(), {}, own);
  EXPECT_NEAR(own[0], 0.5 * 0.8 * 0.8, 1e-12);
}

TEST(Backlash, FlanksPushAndNeverPull) {
  InnerAccelerations own{};
  const Inner pressed{kGap_m / 2 + 0.001, 0}, leaving{kGap_m / 2 + 0.001, -1};
  (void)with_backlash(0).accelerations({.trolley_m = 0.5}, held(), {{pressed}}, own);
  EXPECT_NEAR(own[0], -0.001 * std::pow(kContact_radps, 2), 1e-9);
  (void)with_backlash(0).accelerations({.trolley_m = 0.5}, held(), {{leaving}}, own);
  EXPECT_EQ(own[0], 0);
}

TEST(Backlash, LosesEnergyWhileTheMotorRestsAndStaysInItsGap) {
  for (const double guide : {0.0, 0.5}) {
    const Model model = with_backlash(guide);
    StructureMotion motion{{.trolley_m = 0.5}, {{{0, 0.2}}}};
    const auto energy = [](const Inner& b) {
      const double depth = std::max(0.0, std::abs(b.position) - kGap_m / 2);
      return 0.5 * b.rate * b.rate + 0.5 * std::pow(kContact_radps * depth, 2);
    };
    const double start = energy(motion.inner[0]);
    double last = start;
    for (int i = 0; i < 2000; ++i) {
      motion = test::step(model, motion, held(), kFine_s);
      // integration error of one step of 1 ms at a contact
      EXPECT_LE(energy(motion.inner[0]), last * (1 + 1e-3));
      last = energy(motion.inner[0]);
      EXPECT_LT(std::abs(motion.inner[0].position), kGap_m / 2 + 0.2 / kContact_radps);
    }
    EXPECT_LT(last, 0.01 * start);
  }
}

TEST(Backlash, MovesTheKnownShareOfTheGuideFrictionFromTheMotorToTheLoadSide) {
  constexpr double kLevel_v = 0.6, kShare = 0.4, kGuide = 0.5, kKnown = 0.75;
  const Parameters crane;
  const Model model{crane,
                    {{"drive_friction", "trolley", {{"coulomb_positive_v", kLevel_v}}},
                     {"backlash",
                      "trolley",
                      {{"gap", kGap_m},
                       {"guide_deceleration", kGuide},
                       {"driven_share", kShare},
                       {"known_guide_share", kKnown}}}}};
  const double moved_v = kKnown * kShare * kGuide / crane.trolley_gain_mps2pv;
  EXPECT_NEAR(model.friction_v({.trolley_mps = 0.3}, PerAxis{})[kTrolley], kLevel_v - moved_v, 1e-12);
  EXPECT_NEAR(model.friction_v({.trolley_mps = -0.3}, PerAxis{})[kTrolley], moved_v, 1e-12);
}

/// Torque of the motors without friction, and the parts that accelerate each side.
TEST(FarSide, KeepsTheMomentumOfMotorAndJibWithItsTrolley) {
  constexpr double kShare = 0.65, kVolts = 2;
  Parameters crane;
  crane.load_mass_kg = 0;
  const std::vector<std::vector<TermSetting>> connections{
      {{"backlash", "slew", {{"gap", 0.01}, {"guide_deceleration", 0}, {"driven_share", kShare}}}},
      {{"jib_flexibility", "", {{"compliance_s2", 0.01}, {"jib_share", kShare}}}}};
  for (const auto& terms : connections)
    for (const double bent : {0.0, 0.006, -0.007}) {
      const State state{.trolley_m = 0.8, .trolley_mps = 0.3, .slew_radps = 0.4};
      Actuation actuation;
      actuation.drive_v = {0, kVolts, 0};
      InnerAccelerations own{};
      const Inner inner{bent, 0.2};
      const double motor = Model{crane, terms}.accelerations(state, actuation, {{inner}}, own).slew_radps2;
      const double motor_kgm2 = (1 - kShare) * crane.jib_inertia_kgm2;
      const double jib_kgm2 = kShare * crane.jib_inertia_kgm2 + crane.trolley_mass_kg * 0.8 * 0.8;
      const double coriolis_nm = 2 * crane.trolley_mass_kg * 0.8 * 0.3 * (0.4 + inner.rate);
      EXPECT_NEAR(motor_kgm2 * motor + jib_kgm2 * (motor + own[0]) + coriolis_nm,
                  crane.jib_inertia_kgm2 * crane.slew_gain_radps2pv * kVolts, 1e-9)
          << terms[0].name << " " << bent;
    }
}

TEST(FarSide, ExertsNoForceOnTheMotorInsideTheGap) {
  const Model model{{},
                    {{"backlash", "slew", {{"gap", 0.01}, {"driven_share", 0.65}}},
                     {"backlash", "trolley", {{"gap", 0.01}, {"driven_share", 0.1}}}}};
  InnerAccelerations own{};
  Actuation actuation;
  actuation.drive_v = {1, 2, 0};
  const State hanging{.trolley_m = 0.9, .slew_radps = 0.5};
  const Accelerations a = model.accelerations(hanging, actuation, {}, own);
  EXPECT_NEAR(a.slew_radps2, 2 * Parameters{}.slew_gain_radps2pv / 0.35, 1e-9);
  // With a vertical cable, the centrifugal force of the load causes no force on the trolley.
  EXPECT_NEAR(a.trolley_mps2, Parameters{}.trolley_gain_mps2pv / 0.9, 0.01);
}

/// An unexpected contact stops the motor; then the motor continues where the model expects a contact.
TEST(Backlash, IsCorrectedByTheMeasuredMotorSpeed) {
  constexpr double kHalf = 0.005, kShare = 0.65, kMotor = 0.35 / 0.65;
  Parameters crane;
  crane.trolley_mass_kg = 0;
  const Model model{crane, {{"backlash", "slew", {{"gap", 2 * kHalf}, {"driven_share", kShare}}}}};
  const auto corrected = [&](const Inner& before, Inner now, double change) {
    InnerState inner{{now}};
    model.correct({}, {0, change, 0}, {{before}}, inner);
    return inner[0];
  };
  const Inner struck = corrected({0.001, 0.1}, {0.002, 0.1}, 0.08);
  EXPECT_EQ(struck.position, kHalf);
  EXPECT_NEAR(struck.rate, 0.1 - kMotor * 0.08, 1e-12);
  const Inner missed = corrected({0.004, 0.1}, {0.0051, -0.05}, -0.08);
  EXPECT_EQ(missed.position, kHalf);
  EXPECT_NEAR(missed.rate, -0.05 + kMotor * 0.08, 1e-12);
  const Inner untold = corrected({0.001, 0.1}, {0.002, 0.1}, 0);
  EXPECT_EQ(untold.position, 0.002);
  EXPECT_EQ(untold.rate, 0.1);
}

}  // namespace
}  // namespace crane::plant
