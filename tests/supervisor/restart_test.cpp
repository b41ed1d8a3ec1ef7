// The bridge ends and restarts while the supervisor runs.
#include <gtest/gtest.h>

#include <string_view>

#include "timeline.hpp"

namespace crane::supervisor {
namespace {

constexpr PerAxis kStart{0.7, 0, 1};  // positions of the axes in a new bridge

/// The bridge ends, no state arrives for three seconds, then another bridge starts.
void exchange_bridge(Timeline& t) {
  t.world.state_arrived = t.world.demand_arrived = false;
  t.run(3);
  t.world.demand_arrived = true;
  t.start_bridge(kStart);
  t.world.self_test = SelfTest::running;
  t.tick();
}

void pass_self_test(Timeline& t) {
  t.run(0.1);
  t.world.self_test = SelfTest::passed;
  t.run(1.1);
}

TEST(Restart, ARestartedBridgeAtRestIsTestedAndCanBeResetAndArmed) {  // S25
  Timeline t;
  t.to_hold();
  exchange_bridge(t);
  EXPECT_EQ(t.state(), State::selftest);
  EXPECT_EQ(t.cause(), Cause::bridge_restarted);
  EXPECT_FALSE(t.reset().accepted);
  pass_self_test(t);
  EXPECT_EQ(t.state(), State::locked);
  EXPECT_EQ(t.cause(), Cause::bridge_restarted);
  EXPECT_TRUE(t.safe());
  EXPECT_FALSE(t.out.watchdog_permission);
  EXPECT_TRUE(t.reset().accepted);
  t.run(0.1);
  EXPECT_TRUE(t.arm().accepted);
  t.run(0.5);
  EXPECT_EQ(t.state(), State::hold);
}

TEST(Restart, NothingIsArmedByItself) {  // S25
  Timeline t;
  t.to_run();
  t.demand(5);
  exchange_bridge(t);
  pass_self_test(t);
  for (int i = 0; i < 1000; ++i) {
    t.tick();
    ASSERT_EQ(t.state(), State::locked);
    ASSERT_TRUE(t.safe());
  }
}

TEST(Restart, ABridgeThatIsExchangedWithoutAGapStopsTheCraneAtOnce) {  // S25
  Timeline t;
  t.to_run();
  t.demand(5);
  t.ticks(2);
  ASSERT_TRUE(t.powered());
  t.start_bridge(t.world.sample.position);
  t.tick();
  EXPECT_TRUE(t.safe());
  EXPECT_FALSE(t.out.watchdog_permission);
  EXPECT_EQ(t.cause(), Cause::bridge_restarted);
}

TEST(Restart, TheNewBridgesPositionsAreJudgedFromItsFirstTickOn) {  // S25
  Timeline t;
  t.to_hold();
  exchange_bridge(t);
  pass_self_test(t);
  t.world.sample.position[0] = 1.45;  // long before the ticks of the new bridge reach those of the old bridge
  t.tick();
  EXPECT_EQ(t.state(), State::fault);
  EXPECT_EQ(t.cause(), Cause::brake_did_not_close);
}

TEST(Restart, AnAxisThatWasMovingOrElsewhereHasToBeConfirmed) {  // S26
  struct Case {
    const char* name;
    void (*before)(Timeline&);
  };
  const Case cases[] = {{"moving past its start",
                         [](Timeline& t) {
                           t.speed = {0.3, 0, 0};
                         }},
                        {"elsewhere", [](Timeline& t) {
                           t.speed = {0.3, 0, 0};
                           t.run(1);
                           t.speed = {};
                           t.run(0.5);
                         }}};
  for (const auto& c : cases) {
    Timeline t;
    t.to_run();
    c.before(t);
    t.tick();
    t.speed = {};
    exchange_bridge(t);
    pass_self_test(t);
    const Answer refused = t.reset();
    EXPECT_FALSE(refused.accepted) << c.name;
    EXPECT_NE(std::string_view{refused.reason}.find("trolley"), std::string_view::npos) << refused.reason;
    t.world.confirmed = {false, true, true};
    EXPECT_FALSE(t.reset().accepted) << c.name;
    t.world.confirmed = {true, false, false};
    t.tick();
    EXPECT_TRUE(t.reset().accepted) << c.name;
    EXPECT_EQ(t.state(), State::ready) << c.name;
  }
}

TEST(Restart, AFurtherRestartDoesNotConfirmADoubtfulPosition) {  // S26
  Timeline t;
  t.to_run();
  t.speed = {0, 0.5, 0};
  t.run(0.5);
  t.speed = {};
  exchange_bridge(t);
  t.run(2);
  exchange_bridge(t);
  pass_self_test(t);
  EXPECT_NE(std::string_view{t.reset().reason}.find("slewing jib"), std::string_view::npos);
}

TEST(Restart, AnAxisThatIsToBeHomedNeedsNoConfirmation) {  // S26
  Timeline t;
  t.to_run();
  t.speed = {0.3, 0, 0};
  t.run(0.2);
  t.speed = {};
  t.world.sample.position_unknown = {true, true, false};
  exchange_bridge(t);
  pass_self_test(t);
  EXPECT_TRUE(t.reset().accepted);
  EXPECT_STREQ(t.arm().reason,
               "the position of the trolley is not known: reset, then `crane home --axis trolley`");
}

TEST(Restart, ALoadThatSwungAtTheStartOfTheBridgeRefusesResetUntilTheNextRestart) {  // S26
  Timeline t;
  t.to_hold();
  exchange_bridge(t);
  t.world.sample.swing_radial_rad = 0.02;
  t.run(0.2);
  t.world.sample.swing_radial_rad = 0;
  pass_self_test(t);
  t.world.confirmed = {true, true, true};
  EXPECT_NE(std::string_view{t.reset().reason}.find("load"), std::string_view::npos);
  exchange_bridge(t);
  pass_self_test(t);
  EXPECT_TRUE(t.reset().accepted);
  t.world.sample.swing_radial_rad = 0.3;  // a load may swing later
  t.run(0.1);
  EXPECT_TRUE(t.reset().accepted);
}

TEST(Restart, DoesNotEndAnEmergencyStopOrAFault) {  // S25
  Timeline t;
  t.to_run();
  t.speed = {0.3, 0, 0};
  t.run(1);
  t.speed = {};
  t.estop();
  t.run(0.5);
  exchange_bridge(t);
  EXPECT_EQ(t.state(), State::estop);
  pass_self_test(t);
  EXPECT_EQ(t.state(), State::estop);  // other positions of another bridge are no motion
  EXPECT_FALSE(t.reset().accepted);
  t.world.confirmed = {true, true, true};
  t.tick();
  EXPECT_TRUE(t.reset().accepted);
  EXPECT_EQ(t.state(), State::selftest);  // of the new bridge
  t.tick();
  EXPECT_EQ(t.state(), State::locked);

  t.brakes_obey = false;
  t.world.sample.brake_closed = {false, false, false};
  t.run(0.5);
  ASSERT_EQ(t.state(), State::fault);
  exchange_bridge(t);
  pass_self_test(t);
  EXPECT_EQ(t.state(), State::fault);
}

}  // namespace
}  // namespace crane::supervisor
