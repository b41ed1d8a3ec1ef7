// Terms that add a friction or a force to the volts of a drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "crane/plant/model.hpp"

namespace crane::plant {
namespace {

double friction_v(const std::vector<TermSetting>& terms, double speed_mps, double position_m = 0.5,
                  double drive_v = 0) {
  return Model{{}, terms}.friction_v({.trolley_m = position_m, .trolley_mps = speed_mps}, drive_v, kTrolley);
}

TEST(Terms, DriveFrictionOpposesMotionWithTheNumbersOfItsDirection) {
  const std::vector<TermSetting> terms{{"drive_friction",
                                        "trolley",
                                        {{"viscous_positive_vspm", 1.5},
                                         {"viscous_negative_vspm", 6},
                                         {"coulomb_positive_v", 0.9},
                                         {"coulomb_negative_v", 1.2}}}};
  EXPECT_NEAR(friction_v(terms, 0.2), 0.9 + 1.5 * 0.2, 1e-12);
  EXPECT_NEAR(friction_v(terms, -0.2), -1.2 - 6 * 0.2, 1e-12);
  EXPECT_EQ(friction_v(terms, 0), 0);
  EXPECT_NEAR(friction_v(terms, 0.0005), 0.9 * std::tanh(1.0) + 1.5 * 0.0005, 1e-12);
}

TEST(Terms, StictionIsAnExcessOverCoulombFrictionThatDecaysWithSpeed) {
  const std::vector<TermSetting> terms{
      {"drive_friction", "trolley", {{"coulomb_positive_v", 1}, {"stiction_positive_v", 1.5}}}};
  double highest = 0;
  for (double v = 0; v < 0.02; v += 1e-5) highest = std::max(highest, friction_v(terms, v));
  EXPECT_NEAR(highest, 1.5, 0.05);  // the smoothed step reduces the excess by a few per cent
  EXPECT_NEAR(friction_v(terms, 0.05), 1, 1e-9);
}

TEST(Terms, StribeckExcessFallsToAboutAThirdAtItsDecaySpeed) {
  const std::vector<TermSetting> terms{
      {"stribeck_friction", "trolley", {{"excess_v", 2}, {"decay_speed", 0.1}}}};
  EXPECT_NEAR(friction_v(terms, 0.1), 2 * std::exp(-1.0), 1e-9);
  EXPECT_NEAR(friction_v(terms, -0.1), -2 * std::exp(-1.0), 1e-9);
}

TEST(Terms, PositionDependentFrictionPeaksAtTheTightSpotsAndVanishesBetween) {
  const std::vector<TermSetting> terms{{"position_dependent_friction",
                                        "trolley",
                                        {{"amplitude_v", 2}, {"wavelength", 0.4}, {"tight_at", 0.1}}}};
  EXPECT_NEAR(friction_v(terms, 0.1, 0.5), 2, 1e-9);
  EXPECT_NEAR(friction_v(terms, -0.1, 0.5), -2, 1e-9);
  EXPECT_NEAR(friction_v(terms, 0.1, 0.3), 0, 1e-9);
}

TEST(Terms, CoulombViscousAndAsymmetryEqualDriveFriction) {
  const std::vector<TermSetting> parts{
      {"coulomb_friction", "trolley", {{"level_v", 1.0}}},
      {"viscous_friction", "trolley", {{"vspm", 4.0}}},
      {"direction_asymmetry", "trolley", {{"coulomb_v", -0.2}, {"viscous_vspm", 1.5}}}};
  const std::vector<TermSetting> whole{{"drive_friction",
                                        "trolley",
                                        {{"viscous_positive_vspm", 5.5},
                                         {"viscous_negative_vspm", 2.5},
                                         {"coulomb_positive_v", 0.8},
                                         {"coulomb_negative_v", 1.2}}}};
  for (const double v : {-1.0, -0.01, -0.0003, 0.0, 0.0004, 0.02, 0.7})
    EXPECT_NEAR(friction_v(parts, v), friction_v(whole, v), 1e-12) << v;
}

TEST(Terms, TorqueRippleAddsToTheVoltsByPosition) {
  const std::vector<TermSetting> terms{
      {"torque_ripple", "trolley", {{"amplitude_v", 0.5}, {"phase_rad", 0.3}, {"period", 0.2}}}};
  EXPECT_NEAR(friction_v(terms, 0.1, 0), -0.5 * std::sin(0.3), 1e-12);
  EXPECT_NEAR(friction_v(terms, -0.1, 0.05), -0.5 * std::cos(0.3), 1e-12);
  EXPECT_NEAR(friction_v(terms, 0, 0.25), friction_v(terms, 0, 0.05), 1e-12);
}

TEST(Terms, APositionForceIsASpringWithARestPosition) {
  const std::vector<TermSetting> terms{
      {"position_force", "trolley", {{"stiffness_vpm", 2}, {"offset_v", 1}}}};
  EXPECT_NEAR(friction_v(terms, 0.1, 0.5), 0, 1e-12) << "at rest where k p = o";
  EXPECT_NEAR(friction_v(terms, 0.1, 0.7), 0.4, 1e-12);
  EXPECT_NEAR(friction_v(terms, -0.1, 0.7), 0.4, 1e-12) << "it does not depend on the direction";
}

/// Motor and weight load the gear in opposite directions; when the motor holds the weight, the gear transmits
/// both forces.
TEST(Terms, GearFrictionGrowsWithTheForceThatTheGearTransmits) {
  const std::vector<TermSetting> gear{{"gear_friction", "trolley", {{"share", 0.3}}}};
  EXPECT_NEAR(friction_v(gear, 0.1, 0, 4), 1.2, 1e-12);
  EXPECT_NEAR(friction_v(gear, -0.1, 0, 4), -1.2, 1e-12);
  EXPECT_NEAR(friction_v(gear, 0.1, 0, -4), 1.2, 1e-12) << "the sign of the volts does not count";
  std::vector<TermSetting> with_weight = gear;
  with_weight.push_back({"position_force", "trolley", {{"offset_v", -2}}});
  EXPECT_NEAR(friction_v(with_weight, 0.1, 0, 2), 0.3 * 4 + 2, 1e-12) << "held against a weight of 2 V";
}

}  // namespace
}  // namespace crane::plant
