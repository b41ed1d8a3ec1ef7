// From power-on to HOLD: self-test, reset, arming, and refusals.
#include <gtest/gtest.h>

#include <string_view>

#include "timeline.hpp"

namespace crane::supervisor {
namespace {

TEST(Supervisor, StartsLockedAndNeedsResetAndArmToMove) {  // S1
  Timeline t;
  EXPECT_TRUE(problems(t.limits).empty());
  t.demand(5);
  t.to_locked();
  EXPECT_EQ(t.state(), State::locked);
  EXPECT_EQ(t.cause(), Cause::start);
  EXPECT_TRUE(t.safe());
  EXPECT_FALSE(t.arm().accepted);
  EXPECT_FALSE(t.move().accepted);
  EXPECT_TRUE(t.reset().accepted);
  EXPECT_EQ(t.state(), State::ready);
  EXPECT_TRUE(t.safe());
  EXPECT_FALSE(t.move().accepted);
  t.demand(0);
  EXPECT_TRUE(t.arm().accepted);
  EXPECT_EQ(t.state(), State::arming);
  t.run(0.2);
  EXPECT_EQ(t.state(), State::hold);
  EXPECT_TRUE(t.released());
  EXPECT_TRUE(t.move().accepted);
  EXPECT_EQ(t.state(), State::run);
  t.demand(5);
  t.tick();
  EXPECT_EQ(t.out.drive_v, (PerAxis{5, 5, 0}));
  t.world.reference_moving = false;
  t.tick();
  EXPECT_EQ(t.state(), State::hold);
}

TEST(Supervisor, StaysInSelfTestUntilItIsOver) {  // S2
  Timeline t;
  t.world.self_test = SelfTest::not_started;
  t.run(1);
  EXPECT_EQ(t.state(), State::boot);
  t.world.self_test = SelfTest::running;
  t.run(1);
  EXPECT_EQ(t.state(), State::selftest);
  EXPECT_FALSE(t.reset().accepted);
  t.world.self_test = SelfTest::failed;
  t.tick();
  EXPECT_EQ(t.state(), State::fault);
  EXPECT_EQ(t.cause(), Cause::selftest_failed);
  t.world.self_test = SelfTest::passed;
  t.run(2);
  EXPECT_FALSE(t.reset().accepted);
  EXPECT_EQ(t.state(), State::fault);
}

TEST(Supervisor, EmergencyStopBeforeTheSelfTestLeadsBackToTheSelfTest) {
  Timeline t;
  t.world.self_test = SelfTest::running;
  t.run(0.1);
  t.world.sample.estop_pressed = true;
  t.run(0.1);
  EXPECT_EQ(t.state(), State::estop);
  t.world.sample.estop_pressed = false;
  t.run(1.1);
  EXPECT_TRUE(t.reset().accepted);
  EXPECT_EQ(t.state(), State::selftest);
}

TEST(Supervisor, ActsOnTheRisingEdgeOfAResetOnly) {  // S3
  Timeline t;
  t.to_locked();
  t.world.sample.estop_pressed = true;
  t.tick();
  EXPECT_EQ(t.state(), State::estop);
  t.world.sample.estop_pressed = false;
  for (int i = 0; i < 300; ++i) {
    t.reset();  // held down the whole time
    ASSERT_EQ(t.state(), State::estop);
  }
  t.tick();
  EXPECT_TRUE(t.reset().accepted);
  EXPECT_EQ(t.state(), State::ready);
}

TEST(Supervisor, ResetWaitsUntilTheCauseHasBeenClearForASecond) {  // S3
  Timeline t;
  t.to_hold();
  t.world.sample.estop_pressed = true;
  t.tick();
  EXPECT_EQ(t.state(), State::estop);
  EXPECT_EQ(t.cause(), Cause::estop_input);
  EXPECT_TRUE(t.safe());
  EXPECT_FALSE(t.out.watchdog_permission);
  t.run(1);
  EXPECT_STREQ(t.reset().reason, remedy_for(Cause::estop_input));
  t.world.sample.estop_pressed = false;
  t.run(0.9);
  EXPECT_FALSE(t.reset().accepted);
  t.run(0.2);
  EXPECT_TRUE(t.reset().accepted);
}

TEST(Supervisor, ArmNeedsDemandsForASecond) {  // S4
  Timeline t;
  t.world.demand_arrived = false;
  t.to_ready();
  EXPECT_STREQ(t.arm().reason, remedy_for(Cause::demand_stale));
  t.world.demand_arrived = true;
  t.run(0.5);
  EXPECT_FALSE(t.arm().accepted);
  t.run(0.6);
  EXPECT_TRUE(t.arm().accepted);
}

TEST(Supervisor, ArmingWaitsForADemandThatMatchesACraneAtRest) {  // S12
  Timeline t;
  t.to_ready();
  t.demand(8);
  t.arm();
  t.run(4.9);
  EXPECT_EQ(t.state(), State::arming);
  EXPECT_TRUE(t.safe());
  t.run(0.2);
  EXPECT_EQ(t.cause(), Cause::demand_rate);
  EXPECT_TRUE(t.safe());
  t.run(0.5);
  EXPECT_EQ(t.state(), State::locked);
}

TEST(Supervisor, ArmingFailsWhenABrakeDoesNotOpen) {  // S12
  Timeline t;
  t.brakes_obey = false;
  t.to_hold();
  EXPECT_EQ(t.cause(), Cause::brake_did_not_open);
  EXPECT_TRUE(t.safe());
}

TEST(Supervisor, ArmingFailsWhenAnAxisMovesAsItsBrakeOpens) {  // S12
  Timeline t;
  t.to_ready();
  t.limits.brake_test_time_s = 1;
  t.brakes_obey = false;  // the brake still reports closed, but the axis runs
  t.axes_slip = true;
  t.run(0.1);
  t.arm();
  t.run(0.1);
  t.speed = {0.3, 0, 0};
  t.run(0.15);
  EXPECT_EQ(t.cause(), Cause::stopping_envelope);
  EXPECT_TRUE(t.safe());
}

TEST(Supervisor, ArmingWaitsForTheRelay) {  // S12
  Timeline t;
  t.to_locked();
  t.relay_obeys = false;
  t.world.sample.watchdog_dropped = true;
  t.reset();
  EXPECT_TRUE(t.arm().accepted);
  t.run(1);
  EXPECT_EQ(t.state(), State::arming);
  EXPECT_TRUE(t.safe());
  t.world.sample.watchdog_dropped = false;
  t.run(0.2);
  EXPECT_EQ(t.state(), State::hold);
}

TEST(Supervisor, AMoveThatDoesNotBeginEndsInHold) {
  Timeline t;
  t.to_hold();
  t.ask(Request::move);
  EXPECT_EQ(t.state(), State::run);
  t.run(1.1);
  EXPECT_EQ(t.state(), State::hold);
}

TEST(Supervisor, EveryRefusalNamesAReason) {
  for (int state = 0; state < static_cast<int>(kStates); ++state) {
    for (std::size_t request = 0; request < kRequests; ++request) {
      Memory memory{.state = static_cast<State>(state)};
      Inputs inputs{.now_s = 0.5};
      inputs.requests[request] = true;
      const Outputs out = step(test_limits(), inputs, memory);
      const Answer& answer = out.answers[request];
      EXPECT_TRUE(answer.requested);
      EXPECT_EQ(answer.accepted, std::string_view{answer.reason}.empty()) << state << " " << request;
    }
  }
}

}  // namespace
}  // namespace crane::supervisor
