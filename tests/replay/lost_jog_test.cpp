// A sample of the stick that is missing in a recording follows from the status of the supervisor.
#include "replay/lost_jog.hpp"

#include <gtest/gtest.h>

namespace crane::replay {
namespace {

TEST(LostJog, FollowsFromTheDeflectionOfTheStatus) {
  msg::SupervisorStatus status{};
  EXPECT_FALSE(jog_behind(status, 5));
  status.jog_deflection[1] = -0.3;
  status.move.request_id = 17;
  status.header.tick = 40;
  const auto jog = jog_behind(status, 5);
  ASSERT_TRUE(jog);
  EXPECT_EQ(jog->header.epoch, 5U);
  EXPECT_EQ(jog->request_id, 17U);
  EXPECT_EQ(jog->header.tick, 40U);
  EXPECT_TRUE(jog->engaged);
  EXPECT_EQ(jog->deflection[1], -0.3);
  status.mode = crane_MODE_MAINTENANCE;
  EXPECT_FALSE(jog_behind(status, 5)) << "the supervisor has reduced the deflection";
}

}  // namespace
}  // namespace crane::replay
