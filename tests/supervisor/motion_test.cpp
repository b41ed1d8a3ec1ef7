// Limits of position, speed and swing; brakes that do not follow their commands.
#include <gtest/gtest.h>

#include "timeline.hpp"

namespace crane::supervisor {
namespace {

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

TEST(Supervisor, ComputesTheSpeedFromSampleTimesNotFromThePeriod) {
  Timeline t;
  t.to_run();
  t.demand(3);
  t.speed = {0.9, 0, 0};  // max_speed is 1
  for (int i = 0; i < 20; ++i) {
    const bool late = i % 4 == 2;
    t.late_s = late ? 0.5 * t.limits.period_s : 0;
    const double travel = t.speed[0] * t.late_s;
    t.world.sample.position[0] += travel;
    t.tick();
    t.world.sample.position[0] -= travel;
    ASSERT_EQ(t.state(), State::run) << name_of(t.cause()) << ", tick " << i;
    ASSERT_NEAR(t.memory.motion.speed[0], 0.9, 1e-9);
  }
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

TEST(Supervisor, ASwingBelowTheLimitPermitsArming) {  // S11
  Timeline t;
  for (int i = 0; i < 3000; ++i) {
    const double swing = 0.65 * std::sin(3.13 * i * t.limits.period_s);
    t.world.sample.swing_radial_rad = swing;
    t.demand(-15 * swing);  // gain scheduling reacts to a swing at once
    if (i == 1000) t.world.requests[index_of(Request::reset)] = true;
    if (i == 1100) t.world.requests[index_of(Request::arm)] = true;
    t.tick();
    if (i >= 5 && i < 1000) {
      ASSERT_EQ(t.state(), State::locked);
    }
  }
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

TEST(Supervisor, AWatchdogRelayThatDoesNotOpenIsAFault) {  // S54
  const std::array<void (*)(Timeline&), 3> stops{[](Timeline& t) { t.estop(); },
                                                 [](Timeline& t) { t.world.second_writer = true; },
                                                 [](Timeline& t) { t.disarm(); }};
  for (const auto stop : stops) {
    Timeline t;
    t.to_hold();
    t.relay_obeys = false;
    stop(t);
    t.run(0.5);
    EXPECT_EQ(t.state(), State::fault);
    EXPECT_EQ(t.cause(), Cause::relay_did_not_open);
    t.relay_obeys = true;
    t.run(3);
    EXPECT_FALSE(t.reset().accepted);
  }
}

/// Without this rule, resets in quick succession could hide a welded relay.
TEST(Supervisor, AResetWaitsUntilTheWatchdogRelayHasOpened) {  // S54
  Timeline t;
  t.to_ready();
  t.run(0.1);
  t.relay_obeys = false;
  t.disarm();
  ASSERT_EQ(t.state(), State::locked);
  t.tick();
  EXPECT_FALSE(t.reset().accepted);
  t.relay_obeys = true;
  t.ticks(3);
  EXPECT_TRUE(t.reset().accepted);
}

TEST(Supervisor, OrdinaryBrakingIsNoFault) {  // S13
  for (const double deceleration : {5.0, 8.0, 50.0}) {
    Timeline t;
    t.to_run();
    t.speed = {0.8, 0, 0};
    t.run(0.1);
    t.estop();
    t.axes_slip = true;  // the closed brake stops the axis gradually
    t.ticks(3);
    for (int i = 0; i < 200; ++i) {
      t.speed[0] = std::max(0.0, t.speed[0] - deceleration * t.limits.period_s);
      t.tick();
    }
    EXPECT_EQ(t.state(), State::estop) << deceleration;
  }
}

}  // namespace
}  // namespace crane::supervisor
