/// Friction of a gear or screw that grows with the motor force, on an axis without a weight.
#include <gtest/gtest.h>

#include "crane/diagnosis/diagnosis.hpp"
#include "laboratory/amplifier_runs.hpp"
#include "laboratory/expect_cause.hpp"

namespace crane::diagnosis {
namespace {

/// While the motor drives, the friction has the effect of a smaller gain; while it brakes, of a larger one.
TEST(ScrewAxis, WhoseFrictionGrowsWithTheMotorForceHasNoWeakMotor) {
  strange::Axis screw;
  screw.gear_share = 0.15;
  const Diagnosis found =
      diagnose(rig_of_axis(), inaccurate_runs_of(screw, 21), inaccurate_runs_of(screw, 22));
  expect_cause(found, "gear_friction", screw.gear_share, 0.03);
}

/// In volts, the friction of a heavier carriage is that of the rig file; of a weaker motor, it is larger.
TEST(ScrewAxis, WithAHeavierCarriageHasANamedInertia) {
  strange::Axis heavy;
  heavy.gain_mps2pv *= 0.85;
  const Diagnosis found =
      diagnose(rig_of_axis(), inaccurate_runs_of(heavy, 23), inaccurate_runs_of(heavy, 24));
  EXPECT_EQ(found.verdict, Verdict::parameter) << found.sentence;
  ASSERT_EQ(found.causes.size(), 1U) << found.sentence;
  EXPECT_EQ(found.causes[0].name, "drive_inertia");
  EXPECT_NEAR(found.causes[0].parameters.at(0).value, 1 / 0.85, 0.03);
}

TEST(ScrewAxis, WithAWeakerMotorHasANamedGain) {
  strange::Axis weak;
  weak.gain_mps2pv *= 0.85;
  weak.coulomb_v /= 0.85;
  weak.viscous_vspm /= 0.85;
  const Diagnosis found = diagnose(rig_of_axis(), inaccurate_runs_of(weak, 25), inaccurate_runs_of(weak, 26));
  EXPECT_EQ(found.verdict, Verdict::parameter) << found.sentence;
  ASSERT_EQ(found.causes.size(), 1U) << found.sentence;
  EXPECT_EQ(found.causes[0].name, "motor_gain");
  EXPECT_NEAR(found.causes[0].parameters.at(0).value, 0.85, 0.03);
}

}  // namespace
}  // namespace crane::diagnosis
