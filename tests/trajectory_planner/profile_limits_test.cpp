/// Steps and speeds of the reference of a straight move.
#include "trajectory_planner/profile_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crane::services {
namespace {

using control::ReferenceShape;

class LimitsOfATower : public testing::Test {
 protected:
  [[nodiscard]] ProfileLimits limits(ReferenceShape shape, double from_m, double to_m,
                                     double slew_rad) const {
    control::Reference now;
    now[control::kTrolley].position = from_m;
    return profile_limits(rig_, shape, now, {.selected = {true, true, false}, .target = {to_m, slew_rad, 0}});
  }
  configuration::Rig rig_ = configuration::load_rig(std::string(CRANE_RIGS) + "/virginia_tech_tower.toml");
  double reference_radps_ = rig_.drives[control::kSlew].reference_speed;
};

TEST_F(LimitsOfATower, PermitTheStepsOfTheManeuvers) {
  EXPECT_TRUE(limits(ReferenceShape::step, 0.25, 1.0, 0).steps);
  EXPECT_TRUE(limits(ReferenceShape::step, 0.9, 0.9, 1.5708).steps);
  EXPECT_TRUE(limits(ReferenceShape::step, 0.25, 1.0, 1.5708).steps);
}

TEST_F(LimitsOfATower, ReplaceALargerStepOrAStepNearTheEndOfTheJibByAProfile) {
  EXPECT_FALSE(limits(ReferenceShape::step, 0.9, 0.9, 2.0).steps);
  EXPECT_FALSE(limits(ReferenceShape::step, 1.3, 1.3, 1.0).steps);
  EXPECT_TRUE(limits(ReferenceShape::step, 0.9, 1.3, 0).steps) << "the jib does not turn";
}

TEST_F(LimitsOfATower, KeepTheOutwardSwingOfAProfileThatReplacesAStepSmall) {
  const double speed_radps = limits(ReferenceShape::step, 0.9, 0.9, 3.0).slew_speed_radps;
  EXPECT_NEAR(speed_radps * speed_radps * 0.9 / 9.81, 0.03, 1e-3);
}

TEST_F(LimitsOfATower, TurnMoreSlowlyForEveryLawIfTheTrolleyIsNearItsHighLimit) {
  EXPECT_EQ(limits(ReferenceShape::bang_coast_bang, 0.9, 0.9, 3.0).slew_speed_radps, reference_radps_);
  const double near_radps = limits(ReferenceShape::bang_coast_bang, 1.2, 1.2, 3.0).slew_speed_radps,
               nearer_radps = limits(ReferenceShape::bang_coast_bang, 1.3, 1.3, 3.0).slew_speed_radps;
  EXPECT_LT(near_radps, reference_radps_);
  EXPECT_LT(nearer_radps, near_radps);
  EXPECT_GT(nearer_radps, 0);
}

}  // namespace
}  // namespace crane::services
