// Stops by the operator and by idleness, and the priority of two causes.
#include <gtest/gtest.h>

#include "timeline.hpp"

namespace crane::supervisor {
namespace {

TEST(Supervisor, OperatorStopLetsTheControllersBringTheAxesToRest) {  // S7
  Timeline t;
  t.to_run();
  t.speed = {0.3, 0, 0};
  t.demand(2);
  t.run(0.3);
  EXPECT_TRUE(t.stop().accepted);
  EXPECT_EQ(t.state(), State::stop_c1);
  EXPECT_TRUE(t.out.stop_motion);
  EXPECT_TRUE(t.released());
  EXPECT_EQ(t.out.drive_v[0], 2);
  t.run(0.3);
  EXPECT_TRUE(t.released());
  t.speed = {};
  t.run(0.3);
  EXPECT_TRUE(t.safe());
  EXPECT_EQ(t.state(), State::locked);
  EXPECT_EQ(t.cause(), Cause::operator_stop);
}

TEST(Supervisor, AStopThatTakesTooLongClosesTheBrakes) {  // S7
  Timeline t;
  t.to_run();
  t.demand(1);
  t.speed = {0, 0.2, 0};
  t.stop();
  t.run(7.9);
  EXPECT_TRUE(t.released());
  t.run(0.2);
  EXPECT_EQ(t.cause(), Cause::stop_timeout);
  t.run(0.5);
  EXPECT_EQ(t.state(), State::locked);
  EXPECT_TRUE(t.safe());
}

TEST(Supervisor, DisarmEndsLocked) {  // S7
  Timeline t;
  t.to_hold();
  EXPECT_TRUE(t.disarm().accepted);
  t.run(0.5);
  EXPECT_EQ(t.state(), State::locked);
  EXPECT_EQ(t.cause(), Cause::operator_disarm);
}

TEST(Supervisor, AnOperatorStopReplacesTheCauseOfARoutineStopOnly) {
  Timeline routine;
  routine.to_hold();
  routine.disarm();
  routine.run(0.5);
  ASSERT_EQ(routine.state(), State::locked);
  ASSERT_EQ(routine.cause(), Cause::operator_disarm);
  routine.stop();
  EXPECT_EQ(routine.state(), State::locked);
  EXPECT_EQ(routine.cause(), Cause::operator_stop);

  Timeline fault;
  fault.to_hold();
  fault.world.demand_arrived = false;
  fault.run(0.5);
  ASSERT_EQ(fault.state(), State::locked);
  ASSERT_EQ(fault.cause(), Cause::demand_stale);
  fault.stop();
  EXPECT_EQ(fault.cause(), Cause::demand_stale);
}

TEST(Supervisor, IdleHoldLocksAfterAMinute) {  // S8
  Timeline t;
  t.to_hold();
  t.run(59);
  EXPECT_EQ(t.state(), State::hold);
  t.run(2);
  EXPECT_EQ(t.state(), State::locked);
  EXPECT_EQ(t.cause(), Cause::idle);
}

TEST(Supervisor, AGreaterCauseReplacesALesserOneAndNeverTheOtherWayRound) {  // S15
  Timeline t;
  t.to_run();
  t.speed = {0.2, 0, 0};
  t.run(0.2);
  t.stop();
  EXPECT_EQ(t.cause(), Cause::operator_stop);
  t.world.demand_arrived = false;
  t.ticks(3);
  EXPECT_EQ(t.cause(), Cause::demand_stale);
  t.world.second_writer = true;
  t.tick();
  EXPECT_EQ(t.state(), State::stop_c0);
  t.estop();
  EXPECT_EQ(t.state(), State::estop);
  t.world.second_writer = false;
  t.world.demand_arrived = true;
  t.stop();
  t.run(5);
  EXPECT_EQ(t.state(), State::estop);
  EXPECT_EQ(t.cause(), Cause::operator_estop);
}

}  // namespace
}  // namespace crane::supervisor
