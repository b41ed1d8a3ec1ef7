#include "timeline.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string_view>

namespace crane::supervisor {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

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

TEST(Supervisor, TakesAResetOnItsEdgeOnly) {  // S3
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

// The number in docs/safety.md: demand of tick 0 is the last one; 0 V and brakes in the command of tick 4.
TEST(Supervisor, StopsFourTicksAfterTheLastDemand) {  // S5
  Timeline t;
  t.to_run();
  t.demand(6);
  t.ticks(3);
  t.world.demand_arrived = false;
  t.ticks(2);
  EXPECT_EQ(t.state(), State::run);
  EXPECT_EQ(t.out.drive_v[0], 6);  // rides through two missing demands
  t.tick();
  EXPECT_EQ(t.state(), State::stop_c1);
  EXPECT_EQ(t.cause(), Cause::demand_stale);
  EXPECT_EQ(t.out.drive_v[0], 3);
  EXPECT_TRUE(t.released());
  t.tick();
  EXPECT_TRUE(t.safe());
  EXPECT_LE(demand_loss_to_braked_s(t.limits), 0.07 + 1e-12);
  t.world.demand_arrived = true;
  t.run(2);
  EXPECT_EQ(t.state(), State::locked);  // a signal that recovers does not restart motion
  EXPECT_EQ(t.cause(), Cause::demand_stale);
  EXPECT_TRUE(t.safe());
}

TEST(Supervisor, RampsEvenlyWhenTheRampTakesMoreTicks) {  // S5
  Limits limits = test_limits();
  limits.period_s = 0.005;
  Timeline t{limits};
  t.to_run();
  t.demand(4);
  t.ticks(2);
  t.world.demand_arrived = false;
  t.ticks(2);
  for (const double expected_v : {3.0, 2.0, 1.0, 0.0}) {
    t.tick();
    EXPECT_NEAR(t.out.drive_v[0], expected_v, 1e-12);
    EXPECT_EQ(t.released(), expected_v > 0);
  }
}

TEST(Supervisor, RidesThroughTwoOfThreeDemandsMissing) {
  Timeline t;
  t.to_run();
  for (int i = 0; i < 500; ++i) {
    t.world.demand_arrived = i % 3 == 0;
    t.tick();
    ASSERT_EQ(t.state(), State::run);
  }
}

TEST(Supervisor, StopsOnTheThirdDemandThatIsNotFinite) {  // S6
  Timeline t;
  t.to_run();
  t.demand(4);
  t.tick();
  t.demand(kNotANumber);
  t.ticks(2);
  EXPECT_EQ(t.state(), State::run);
  EXPECT_EQ(t.out.drive_v[0], 4);
  t.tick();
  EXPECT_EQ(t.cause(), Cause::demand_invalid);
  t.tick();
  EXPECT_TRUE(t.safe());
}

TEST(Supervisor, StopsWhenTheStateStopsComing) {  // S5
  Timeline t;
  t.to_run();
  t.demand(4);
  t.tick();
  t.world.state_arrived = false;
  t.ticks(3);
  EXPECT_EQ(t.cause(), Cause::state_stale);
  t.tick();
  EXPECT_TRUE(t.safe());
  t.run(3);
  EXPECT_EQ(t.state(), State::stop_c1);  // nobody knows yet whether it stands
  t.world.state_arrived = true;
  t.run(0.5);
  EXPECT_EQ(t.state(), State::locked);
}

TEST(Supervisor, TreatsAStateThatIsNotFiniteAsMissing) {
  Timeline t;
  t.to_run();
  t.world.sample.swing_radial_rad = kNotANumber;
  t.ticks(3);
  EXPECT_EQ(t.cause(), Cause::state_stale);
}

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

TEST(Supervisor, IdleHoldLocksAfterAMinute) {  // S8
  Timeline t;
  t.to_hold();
  t.run(59);
  EXPECT_EQ(t.state(), State::hold);
  t.run(2);
  EXPECT_EQ(t.state(), State::locked);
  EXPECT_EQ(t.cause(), Cause::idle);
}

TEST(Supervisor, AMoveThatNeverBeginsEndsInHold) {
  Timeline t;
  t.to_hold();
  t.ask(Request::move);
  EXPECT_EQ(t.state(), State::run);
  t.run(1.1);
  EXPECT_EQ(t.state(), State::hold);
}

TEST(Supervisor, StopsBeforeThePositionLimit) {  // S9
  Timeline t;
  t.to_run();
  t.demand(3);
  t.speed = {0.9, 0, 0};
  while (t.state() == State::run) t.tick();
  EXPECT_EQ(t.cause(), Cause::stopping_envelope);
  EXPECT_EQ(t.out.drive_v[0], 0);  // no voltage towards the limit, not even during the ramp
  const double left = t.limits.axis[0].high_limit - t.world.sample.position[0];
  EXPECT_GE(left + 0.9 * t.limits.period_s, stopping_distance(t.limits, 0, 0.9) - 1e-9);
  t.run(0.5);
  EXPECT_EQ(t.state(), State::locked);
  EXPECT_LT(t.world.sample.position[0], t.limits.axis[0].high_limit);
}

TEST(Supervisor, CutsPowerBeyondThePositionLimitAndStaysLockedThere) {  // S9
  Timeline t;
  t.to_run();
  t.world.sample.position[0] = 1.405;
  t.tick();
  EXPECT_EQ(t.state(), State::stop_c0);
  EXPECT_TRUE(t.safe());
  t.run(3);
  EXPECT_STREQ(t.reset().reason, remedy_for(Cause::position_limit));
}

struct PowerOff {
  const char* name;
  void (*cause)(Timeline&);
  Cause expected;
};

TEST(Supervisor, CutsPowerAndBrakesInTheTickThatShowsTheCause) {  // S10
  const PowerOff cases[] = {
      {"second writer", [](Timeline& t) { t.world.second_writer = true; }, Cause::second_writer},
      {"stale commands", [](Timeline& t) { t.world.sample.command_stale = true; }, Cause::bridge_latched},
      {"invalid command", [](Timeline& t) { t.world.sample.command_invalid = true; }, Cause::bridge_latched},
      {"relay", [](Timeline& t) { t.world.sample.watchdog_dropped = true; }, Cause::bridge_latched},
      {"limit switch", [](Timeline& t) { t.world.sample.limit_low[1] = true; }, Cause::limit_switch},
      {"encoder jump", [](Timeline& t) { t.world.sample.position[1] += 0.03; }, Cause::overspeed},
      {"brake closed by itself", [](Timeline& t) { t.world.sample.brake_closed[0] = true; },
       Cause::brake_did_not_open}};
  for (const PowerOff& c : cases) {
    Timeline t;
    t.to_run();
    t.demand(5);
    t.ticks(2);
    ASSERT_TRUE(t.powered());
    c.cause(t);
    t.tick();
    EXPECT_EQ(t.state(), State::stop_c0) << c.name;
    EXPECT_EQ(t.cause(), c.expected) << c.name;
    EXPECT_TRUE(t.safe()) << c.name;
    EXPECT_FALSE(t.out.watchdog_permission) << c.name;
  }
}

TEST(Supervisor, SwingAboveTheLimitIsDampedFirstAndBrakedWhenItGrows) {  // S11
  Timeline t;
  t.to_run();
  t.speed = {0.2, 0, 0};
  t.demand(2);
  t.run(0.2);
  t.world.sample.swing_tangential_rad = 0.75;
  t.tick();
  EXPECT_EQ(t.state(), State::stop_c1);
  EXPECT_EQ(t.cause(), Cause::swing_limit);
  t.run(0.2);
  EXPECT_TRUE(t.released());
  t.world.sample.swing_tangential_rad = -0.9;
  t.ticks(2);
  EXPECT_TRUE(t.safe());
}

TEST(Supervisor, AFreelySwingingLoadIsNoFaultAndBelowTheLimitDoesNotHinderArming) {  // S11
  Timeline t;
  for (int i = 0; i < 3000; ++i) {
    const double swing = 0.65 * std::sin(3.13 * i * t.limits.period_s);
    t.world.sample.swing_radial_rad = swing;
    t.demand(-15 * swing);  // gain scheduling answers a swing at once
    if (i == 1000) t.world.requests[index_of(Request::reset)] = true;
    if (i == 1100) t.world.requests[index_of(Request::arm)] = true;
    t.tick();
    if (i >= 5 && i < 1000) {
      ASSERT_EQ(t.state(), State::locked);
    }
  }
  EXPECT_EQ(t.state(), State::hold);
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

TEST(Supervisor, MotionAfterTheBrakesShouldHaveStoppedItIsAFault) {  // S13
  Timeline t;
  t.to_run();
  t.speed = {0.5, 0, 0};
  t.run(0.3);
  t.axes_slip = true;
  t.estop();
  EXPECT_EQ(t.state(), State::estop);
  t.run(0.3);
  EXPECT_EQ(t.state(), State::fault);
  EXPECT_EQ(t.cause(), Cause::brake_did_not_close);
  t.axes_slip = false;
  t.run(3);
  EXPECT_FALSE(t.reset().accepted);
  EXPECT_EQ(t.state(), State::fault);
}

TEST(Supervisor, ABrakeThatDoesNotReportClosedIsAFault) {  // S13
  Timeline t;
  t.to_hold();
  t.brakes_obey = false;
  t.world.second_writer = true;
  t.tick();
  EXPECT_EQ(t.state(), State::stop_c0);
  t.run(0.2);
  EXPECT_EQ(t.state(), State::fault);
}

TEST(Supervisor, OrdinaryBrakingIsNoFault) {  // S13
  for (const double deceleration : {5.0, 8.0, 50.0}) {
    Timeline t;
    t.to_run();
    t.speed = {0.8, 0, 0};
    t.run(0.1);
    t.estop();
    t.axes_slip = true;  // slides to a stop, as a braked axis does
    t.ticks(3);
    for (int i = 0; i < 200; ++i) {
      t.speed[0] = std::max(0.0, t.speed[0] - deceleration * t.limits.period_s);
      t.tick();
    }
    EXPECT_EQ(t.state(), State::estop) << deceleration;
  }
}

TEST(Supervisor, LateTicksInARowStopTheCrane) {  // S14
  Timeline t;
  t.to_run();
  for (int i = 0; i < 20; ++i) {
    ++t.world.sample.overruns;
    t.ticks(2);
  }
  EXPECT_EQ(t.state(), State::run);
  for (int i = 0; i < 3; ++i) {
    ++t.world.sample.overruns;
    t.tick();
  }
  EXPECT_EQ(t.cause(), Cause::overrun);
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

TEST(Supervisor, EveryRefusalNamesAReason) {
  for (int state = 0; state < static_cast<int>(kStates); ++state) {
    for (std::size_t request = 0; request < kRequests; ++request) {
      Memory memory{.state = static_cast<State>(state)};
      Inputs inputs{.now_s = 0.5};
      inputs.requests[request] = true;
      const Outputs out = step(test_limits(), inputs, memory);
      const Answer& answer = out.answers[request];
      EXPECT_TRUE(answer.asked);
      EXPECT_EQ(answer.accepted, std::string_view{answer.reason}.empty()) << state << " " << request;
    }
  }
}

}  // namespace
}  // namespace crane::supervisor
