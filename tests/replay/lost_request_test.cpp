// A request that is missing in a recording follows from its reply and the statuses around it.
#include "replay/lost_request.hpp"

#include <gtest/gtest.h>

#include "crane/runtime/node.hpp"

namespace crane::replay {
namespace {

class LostRequest : public testing::Test {
 protected:
  LostRequest() {
    reply_.accepted = true;
    reply_.request_id = 17;
    runtime::assign(reply_.client, "crane 4711");
  }
  [[nodiscard]] crane_RequestKind kind() const {
    const auto request = request_behind(reply_, before_, after_);
    if (!request) return crane_REQUEST_NONE;
    EXPECT_EQ(request->id, 17U);
    EXPECT_STREQ(request->client, "crane 4711");
    EXPECT_EQ(request->header.source, crane_SOURCE_OPERATOR);
    return request->kind;
  }
  void states(crane_SupervisorState before, crane_SupervisorState after) {
    before_.state = before;
    after_.state = after;
  }
  msg::Reply reply_{};
  msg::SupervisorStatus before_{}, after_{};
};

TEST_F(LostRequest, OfAResetOpensTheLock) {
  states(crane_STATE_LOCKED, crane_STATE_READY);
  EXPECT_EQ(kind(), crane_REQUEST_RESET);
  states(crane_STATE_ESTOP, crane_STATE_READY);
  EXPECT_EQ(kind(), crane_REQUEST_RESET);
}

TEST_F(LostRequest, OfArmingAndHomingBeginsToArm) {
  states(crane_STATE_READY, crane_STATE_ARMING);
  EXPECT_EQ(kind(), crane_REQUEST_ARM);
  after_.homing[2] = true;
  EXPECT_EQ(kind(), crane_REQUEST_HOME);
  const auto request = request_behind(reply_, before_, after_);
  EXPECT_FALSE(request->selected[0]);
  EXPECT_TRUE(request->selected[2]);
}

TEST_F(LostRequest, OfAStopIsNamedByItsCause) {
  states(crane_STATE_RUN, crane_STATE_STOP_C1);
  after_.cause = crane_CAUSE_OPERATOR_STOP;
  EXPECT_EQ(kind(), crane_REQUEST_STOP);
  after_.cause = crane_CAUSE_OPERATOR_DISARM;
  EXPECT_EQ(kind(), crane_REQUEST_DISARM);
  after_.cause = crane_CAUSE_OPERATOR_ESTOP;
  EXPECT_EQ(kind(), crane_REQUEST_ESTOP);
  before_.cause = crane_CAUSE_OPERATOR_ESTOP;
  EXPECT_EQ(kind(), crane_REQUEST_NONE) << "the crane was stopped before";
}

TEST_F(LostRequest, OfAMoveIsInTheStatus) {
  states(crane_STATE_HOLD, crane_STATE_RUN);
  after_.move.number = 3;
  after_.move.request_id = 17;
  runtime::assign(after_.move.client, "crane 4711");
  after_.move.kind = crane_REQUEST_FOLLOW;
  after_.move.selected[1] = true;
  after_.move.target[1] = 0.7;
  after_.move.sine[2].amplitude = 0.1;
  after_.move.duration_s = 4;
  ASSERT_EQ(kind(), crane_REQUEST_FOLLOW);
  const auto request = request_behind(reply_, before_, after_);
  EXPECT_TRUE(request->selected[1]);
  EXPECT_EQ(request->target[1], 0.7);
  EXPECT_EQ(request->sine[2].amplitude, 0.1);
  EXPECT_EQ(request->duration_s, 4);
  after_.move.request_id = 18;
  EXPECT_EQ(kind(), crane_REQUEST_NONE) << "the move of another request";
}

TEST_F(LostRequest, OfAModeIsTheModeOfTheStatus) {
  states(crane_STATE_LOCKED, crane_STATE_LOCKED);
  after_.mode = crane_MODE_MANUAL;
  ASSERT_EQ(kind(), crane_REQUEST_MODE);
  EXPECT_EQ(request_behind(reply_, before_, after_)->mode, crane_MODE_MANUAL);
}

TEST_F(LostRequest, WithoutAnEffectIsUnknown) {
  states(crane_STATE_HOLD, crane_STATE_HOLD);
  EXPECT_EQ(kind(), crane_REQUEST_NONE);
}

TEST_F(LostRequest, OfAStickIsInTheStatus) {
  EXPECT_FALSE(jog_behind(after_));
  after_.jog_deflection[1] = -0.3;
  after_.move.request_id = 17;
  after_.header.tick = 40;
  const auto jog = jog_behind(after_);
  ASSERT_TRUE(jog);
  EXPECT_EQ(jog->request_id, 17U);
  EXPECT_EQ(jog->header.tick, 40U);
  EXPECT_TRUE(jog->engaged);
  EXPECT_EQ(jog->deflection[1], -0.3);
  after_.mode = crane_MODE_MAINTENANCE;
  EXPECT_FALSE(jog_behind(after_)) << "the supervisor has reduced the deflection";
}

TEST_F(LostRequest, IsNamedWithItsClient) {
  states(crane_STATE_READY, crane_STATE_ARMING);
  EXPECT_EQ(in_words(*request_behind(reply_, before_, after_)), "arm of client 'crane 4711'");
}

}  // namespace
}  // namespace crane::replay
