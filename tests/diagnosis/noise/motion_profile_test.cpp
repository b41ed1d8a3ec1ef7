#include "noise/motion_profile.hpp"

#include <gtest/gtest.h>

namespace crane::diagnosis {
namespace {

/// 1 s at 0.1 m/s, 1 s of rest, 1 s back.
TEST(MotionProfile, HasThePhasesOfTheMotion) {
  PreparedRun run;
  std::vector<double>& position = run.on_grid[kTrolleyPosition];
  double x = 0;
  for (int k = 0; k < 300; ++k) position.push_back(x += k < 100 ? 1e-3 : k < 200 ? 0 : -1e-3);
  run.run.period_s = 0.01;
  run.run.measured[kTrolleyPosition] = position;
  const MotionProfile profile = motion_profile_of(run, kTrolleyPosition, 20, 260);
  EXPECT_EQ(profile[30].phase, MotionPhase::moving);
  EXPECT_LT(profile[30].slowness, 1e-9);
  EXPECT_EQ(profile[130].phase, MotionPhase::standing);
  EXPECT_EQ(profile[130].slowness, 1);
  EXPECT_NE(profile[82].phase, MotionPhase::standing) << "it moved a few rows before";
  EXPECT_EQ(profile[230].phase, MotionPhase::moving);
}

}  // namespace
}  // namespace crane::diagnosis
