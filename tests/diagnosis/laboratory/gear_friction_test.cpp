/// Friction of a gear or screw that grows with the motor force, on an axis without a weight.
#include <gtest/gtest.h>

#include "crane/diagnosis/diagnosis.hpp"
#include "laboratory/amplifier_runs.hpp"

namespace crane::diagnosis {
namespace {

/// While the motor drives, the friction has the effect of a smaller gain; while it brakes, of a larger one.
TEST(ScrewAxis, WhoseFrictionGrowsWithTheMotorForceHasNoWeakMotor) {
  strange::Axis screw;
  screw.gear_share = 0.15;
  const Diagnosis found =
      diagnose(rig_of_axis(), inaccurate_runs_of(screw, 21), inaccurate_runs_of(screw, 22));
  EXPECT_EQ(found.verdict, Verdict::named) << found.sentence;
  ASSERT_EQ(found.causes.size(), 1U) << found.sentence;
  EXPECT_EQ(found.causes[0].name, "gear_friction");
  EXPECT_NEAR(found.causes[0].parameters.at(0).value, screw.gear_share, 0.03);
}

TEST(ScrewAxis, WithAWeakMotorHasNoGearFriction) {
  strange::Axis weak;
  weak.gain_mps2pv *= 0.85;
  const Diagnosis found = diagnose(rig_of_axis(), inaccurate_runs_of(weak, 23), inaccurate_runs_of(weak, 24));
  for (const Cause& cause : found.causes) EXPECT_NE(cause.name, "gear_friction") << found.sentence;
}

}  // namespace
}  // namespace crane::diagnosis
