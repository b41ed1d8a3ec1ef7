// Brakes, their supply, the watchdog relay and the emergency stop of the simulated board.
#include <gmock/gmock.h>

#include <cmath>

#include "board_bench.hpp"
#include "closed_loop.hpp"

namespace crane::simulator {
namespace {

TEST(Brakes, AreClosedAtStartAndHoldExactlyAgainstTheMotors) {
  Bench bench;
  bench.board.kick(0.5, 0.5);
  bench.tick({10, 10, 10}, false, 100);
  EXPECT_EQ(bench.board.truth().trolley_m, 0.25);
  EXPECT_EQ(bench.board.truth().slew_rad, 0);
  EXPECT_EQ(bench.board.truth().cable_m, 1);
  EXPECT_NE(bench.board.truth().radial_rad, 0);  // the load swings on
}

TEST(Brakes, OpenOnlyWhenTheWatchdogHasToggledForAWhileAndTheOpeningTimeIsOver) {
  Bench bench;
  std::vector<bool> closed, dropped;
  for (int i = 0; i < 9; ++i) {
    bench.tick({}, true);
    closed.push_back(bench.board.read().brake_closed[0]);
    dropped.push_back(bench.board.read().watchdog_dropped);
  }
  // the sixth write is 50 ms after the first; 20 ms later the brake is open
  EXPECT_EQ(dropped, (std::vector<bool>{true, true, true, true, true, false, false, false, false}));
  EXPECT_EQ(closed, (std::vector<bool>{true, true, true, true, true, true, false, false, false}));
}

TEST(Brakes, StayClosedWithoutPermissionOrRelease) {
  Bench bench;
  bench.tick({1, 1, 0}, false, 30);
  EXPECT_FALSE(bench.board.read().watchdog_dropped);
  EXPECT_TRUE(bench.board.read().brake_closed[0]);
  EXPECT_EQ(bench.board.truth().trolley_m, 0.25);
}

TEST(Brakes, StopAMovingAxisWithTheirDecelerationAndThenHoldItWithoutCreep) {
  SimulatedRig rig;
  rig.parameters.load_mass_kg = 0;
  Bench bench{rig};
  bench.open_brakes();
  bench.tick({5, 0, 0}, true, 10);  // 10 m/s2 for 0.1 s
  const double v = bench.board.truth().trolley_mps, x = bench.board.truth().trolley_m;
  ASSERT_NEAR(v, 1, 0.01);
  bench.tick({0, 0, 0}, false, 100);
  // the trolley moves at constant speed for 20 ms, then decelerates with 5 m/s2 (inertia of the trolley of
  // 22.46 kg, no load)
  EXPECT_NEAR(bench.board.truth().trolley_m - x, v * 0.02 + v * v / (2 * 5), 1e-3);
  EXPECT_EQ(bench.board.truth().trolley_mps, 0);
  const double rest = bench.board.truth().trolley_m;
  bench.tick({10, 10, 10}, false, 100);
  EXPECT_EQ(bench.board.truth().trolley_m, rest);
}

TEST(Brakes, NeverReverseTheMotionOfALoadedCrane) {
  SimulatedRig rig;
  rig.terms = test::rig_friction();
  Bench bench{rig};
  bench.open_brakes();
  bench.tick({4, 3, 2}, true, 30);
  double x = bench.board.truth().trolley_m, slew = bench.board.truth().slew_rad;
  for (int i = 0; i < 100; ++i) {
    bench.tick({}, false);
    EXPECT_GE(bench.board.truth().trolley_m, x);
    EXPECT_GE(bench.board.truth().slew_rad, slew);
    x = bench.board.truth().trolley_m;
    slew = bench.board.truth().slew_rad;
  }
  EXPECT_EQ(bench.board.truth().slew_radps, 0);
  EXPECT_EQ(bench.board.truth().cable_mps, 0);
}

TEST(Watchdog, DropsTheBrakesWhenItsOutputStandsStillForMoreThan50Milliseconds) {
  Bench bench;
  bench.open_brakes();
  bench.pass(4);  // 50 ms after the last change, which was one tick before
  EXPECT_FALSE(bench.board.read().watchdog_dropped);
  bench.pass();
  EXPECT_TRUE(bench.board.read().watchdog_dropped);
  bench.pass(2);
  EXPECT_TRUE(bench.board.read().brake_closed[0]);
}

TEST(Watchdog, StaysDroppedUntilItHasToggledForAWhileAgain) {
  Bench bench;
  bench.open_brakes();
  bench.pass(20);
  bench.tick({}, true, 5);
  EXPECT_TRUE(bench.board.read().watchdog_dropped);
  bench.pass(10);  // after a gap the count begins again
  bench.tick({}, true, 5);
  EXPECT_TRUE(bench.board.read().watchdog_dropped);
  bench.tick({}, true);
  EXPECT_FALSE(bench.board.read().watchdog_dropped);
}

TEST(Watchdog, IgnoresWritesThatDoNotToggle) {
  Bench bench;
  bench.open_brakes();
  for (int i = 0; i < 10; ++i) {
    bench.board.write(bench.outputs);
    bench.pass();
  }
  EXPECT_TRUE(bench.board.read().watchdog_dropped);
}

TEST(EmergencyStop, CutsTheBrakeSupplyByWire) {
  Bench bench;
  bench.open_brakes();
  bench.board.press_estop(true);
  bench.tick({}, true, 3);
  EXPECT_TRUE(bench.board.read().estop_pressed);
  EXPECT_TRUE(bench.board.read().brake_closed[1]);
  bench.board.press_estop(false);
  bench.tick({}, true, 3);
  EXPECT_FALSE(bench.board.read().brake_closed[1]);
}

TEST(MakeSafe, OutputsZeroVoltsAndClosesTheBrakes) {
  Bench bench;
  bench.open_brakes();
  bench.tick({2, 2, 2}, true, 20);
  bench.board.make_safe();
  bench.pass(200);
  EXPECT_TRUE(bench.board.read().brake_closed[0]);
  EXPECT_EQ(bench.board.truth().trolley_mps, 0);
  EXPECT_EQ(bench.board.truth().slew_radps, 0);
}

}  // namespace
}  // namespace crane::simulator
