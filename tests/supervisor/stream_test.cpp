// Demands and states that are late, missing or not finite.
#include <gtest/gtest.h>

#include <limits>

#include "timeline.hpp"

namespace crane::supervisor {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// The number in docs/safety.md: demand of tick 0 is the last one; 0 V and brakes in the command of tick 4.
TEST(Supervisor, StopsFourTicksAfterTheLastDemand) {  // S5
  Timeline t;
  t.to_run();
  t.demand(6);
  t.ticks(3);
  t.world.demand_arrived = false;
  t.ticks(2);
  EXPECT_EQ(t.state(), State::run);
  EXPECT_EQ(t.out.drive_v[0], 6);  // the gate holds the voltage during two missing demands
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

TEST(Supervisor, RampsEvenlyOverMoreTicksAtAShorterPeriod) {  // S5
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

TEST(Supervisor, ToleratesTwoMissingDemandsOfThree) {
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
  EXPECT_EQ(t.state(), State::stop_c1);  // without a state, standstill is unknown
  t.world.state_arrived = true;
  t.run(0.5);
  EXPECT_EQ(t.state(), State::locked);
}

TEST(Supervisor, TreatsAStateThatIsNotFiniteAsMissing) {
  using Value = double& (*)(Timeline&);
  constexpr std::array<Value, 5> kValues{
      [](Timeline& t) -> double& { return t.bridge_clock_ahead_s; },
      [](Timeline& t) -> double& { return t.world.sample.position[1]; },
      [](Timeline& t) -> double& { return t.world.sample.swing_radial_rad; },
      [](Timeline& t) -> double& { return t.world.sample.swing_tangential_rad; },
      [](Timeline& t) -> double& { return t.world.sample.applied_v[0]; }};
  for (std::size_t i = 0; i < kValues.size(); ++i) {
    Timeline t;
    t.to_run();
    kValues[i](t) = kNotANumber;
    t.ticks(3);
    EXPECT_EQ(t.cause(), Cause::state_stale) << i;
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

}  // namespace
}  // namespace crane::supervisor
