#include "crane/simulator/simulated_board.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "closed_loop.hpp"

namespace crane::simulator {
namespace {

using bridge::Inputs;
using bridge::Outputs;
using testing::HasSubstr;

constexpr std::int64_t kTick_ns = 10'000'000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A board and the caller's side of its loop.
class Bench {
 public:
  explicit Bench(const SimulatedRig& rig = {}) : board(rig) {}

  /// Writes and lets ticks pass, toggling the watchdog output in each.
  void tick(const std::array<double, 3>& drive_v, bool release, int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      outputs.drive_v = drive_v;
      outputs.brake_release = {release, release, release};
      outputs.watchdog_level = !outputs.watchdog_level;
      applied_v = board.write(outputs);
      pass();
    }
  }
  /// Nobody writes.
  void pass(int ticks = 1) { board.advance_to(board.now_ns() + ticks * kTick_ns); }
  /// Relay closed, brakes open.
  void open_brakes() { tick({}, true, 12); }

  SimulatedBoard board;
  Outputs outputs;
  std::array<double, 3> applied_v{};
};

// --- converters
// -------------------------------------------------------------------------------------------------

TEST(Converter, CodesAreInvertedOffsetBinaryClampedToThirteenBits) {
  EXPECT_EQ(converter_code(0), 0x1000);
  EXPECT_EQ(converter_code(10), 0);
  EXPECT_EQ(converter_code(11), 0);
  EXPECT_EQ(converter_code(-10), 0x1FFF);  // clamped, never wrapped to +10 V
  EXPECT_EQ(converter_code(-1e300), 0x1FFF);
  EXPECT_EQ(converter_code(5), 0x800);
  EXPECT_EQ(converter_code(-5), 0x1800);
}

TEST(Converter, GivesVoltagesWithinHalfAStepOfWhatWasAsked) {
  constexpr double kStep_v = 20.0 / 8192;
  for (double v = -9.99; v < 10; v += 0.0137) {
    EXPECT_LE(std::abs(converter_voltage_v(converter_code(v)) - v), kStep_v / 2 + 1e-12) << v;
  }
  EXPECT_DOUBLE_EQ(converter_voltage_v(0), 10);
  EXPECT_DOUBLE_EQ(converter_voltage_v(0x1FFF), -10 + kStep_v);
}

TEST(Converter, GivesNoVoltageForWhatIsNoNumber) {
  Bench bench;
  bench.tick({kNan, kInfinity, -kInfinity}, false);
  EXPECT_EQ(bench.applied_v, (std::array<double, 3>{0, 0, 0}));
}

// --- encoders
// ---------------------------------------------------------------------------------------------------

TEST(Encoders, CountAbsoluteCoordinatesOfTheDissertationsRig) {
  SimulatedRig rig;
  rig.start = {.trolley_m = 0.5, .radial_rad = 0.1, .slew_rad = 1, .tangential_rad = -0.1, .cable_m = 1.2};
  const Inputs inputs = SimulatedBoard{rig}.read();
  EXPECT_EQ(inputs.raw_counts[0], std::lround(0.5 * 8000 / 0.0127));
  EXPECT_EQ(inputs.raw_counts[1], std::lround(360000 / (2 * std::numbers::pi)));
  EXPECT_EQ(inputs.raw_counts[2], 192000);
  EXPECT_EQ(inputs.raw_counts[3], 382);  // 0.1 * 24000 / 2 pi = 381.97
  EXPECT_EQ(inputs.raw_counts[4], -382);
}

TEST(Encoders, CountDownwardsWithANegativeSign) {
  SimulatedRig rig;
  rig.encoders[0] = {.counts_per_unit = 1000, .sign = -1};
  EXPECT_EQ(SimulatedBoard{rig}.read().raw_counts[0], -250);
}

TEST(Encoders, WrapAt24BitsWithTheirSign) {
  EXPECT_EQ(wrap_24_bit(0x7FFFFF), 8388607);
  EXPECT_EQ(wrap_24_bit(0x800000), -8388608);
  EXPECT_EQ(wrap_24_bit(-1), -1);
  EXPECT_EQ(wrap_24_bit(-0x800001), 0x7FFFFF);
  EXPECT_EQ(wrap_24_bit(0x1000000), 0);
  SimulatedRig rig;
  rig.encoders[0].counts_per_unit = 4.0 * 8388608;  // the start at 0.25 m is exactly half way round
  EXPECT_EQ(SimulatedBoard{rig}.read().raw_counts[0], -8388608);
}

// --- brakes and watchdog
// ----------------------------------------------------------------------------------------

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
  // 20 ms of rolling on, then 5 m/s2 (the trolley's own 22.46 kg, no load)
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
  bench.pass(10);  // a gap: the count starts anew
  bench.tick({}, true, 5);
  EXPECT_TRUE(bench.board.read().watchdog_dropped);
  bench.tick({}, true);
  EXPECT_FALSE(bench.board.read().watchdog_dropped);
}

TEST(Watchdog, IsNotFooledByWritesThatDoNotToggle) {
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

TEST(MakeSafe, TakesVoltagesAwayAndClosesTheBrakes) {
  Bench bench;
  bench.open_brakes();
  bench.tick({2, 2, 2}, true, 20);
  bench.board.make_safe();
  bench.pass(200);
  EXPECT_TRUE(bench.board.read().brake_closed[0]);
  EXPECT_EQ(bench.board.truth().trolley_mps, 0);
  EXPECT_EQ(bench.board.truth().slew_radps, 0);
}

// --- travel
// -----------------------------------------------------------------------------------------------------

TEST(Travel, SwitchesReportTheirEndAndStopsHoldTheAxisThere) {
  SimulatedRig rig;
  rig.drives[plant::kTrolley].high_switch = 0.4;
  rig.drives[plant::kTrolley].high_stop = 0.45;
  rig.drives[plant::kTrolley].low_switch = 0.2;
  rig.drives[plant::kTrolley].low_stop = 0.15;
  Bench bench{rig};
  bench.open_brakes();
  EXPECT_FALSE(bench.board.read().limit_high[0]);
  bench.tick({2, 0, 0}, true, 100);
  EXPECT_TRUE(bench.board.read().limit_high[0]);
  EXPECT_NEAR(bench.board.truth().trolley_m, 0.45, 0.02);  // the swinging load may lift it off for a moment
  EXPECT_LE(bench.board.truth().trolley_m, 0.45);
  bench.tick({-2, 0, 0}, true, 100);
  EXPECT_TRUE(bench.board.read().limit_low[0]);
  EXPECT_FALSE(bench.board.read().limit_high[0]);
  EXPECT_GE(bench.board.truth().trolley_m, 0.15);
}

TEST(Travel, AStopTakesMotionAndNeverGivesIt) {
  SimulatedRig rig;
  rig.parameters.load_mass_kg = 0;
  rig.drives[plant::kTrolley].high_stop = 0.5;
  Bench bench{rig};
  bench.open_brakes();
  bench.tick({3, 0, 0}, true, 100);
  EXPECT_EQ(bench.board.truth().trolley_m, 0.5);
  EXPECT_EQ(bench.board.truth().trolley_mps, 0);
  bench.tick({-1, 0, 0}, true, 10);
  EXPECT_NEAR(bench.board.truth().trolley_m, 0.49, 1e-3);  // K_m V t^2 / 2 = 1 cm
}

TEST(Drives, TurnTheOtherWayWithANegativeSign) {
  SimulatedRig rig;
  rig.drives[plant::kSlew].sign = -1;
  Bench bench{rig};
  bench.open_brakes();
  bench.tick({0, 1, 0}, true, 10);
  EXPECT_EQ(bench.applied_v[1], converter_voltage_v(converter_code(1)));
  EXPECT_LT(bench.board.truth().slew_rad, 0);
}

TEST(Drives, ThatAreAbsentNeverMove) {
  SimulatedRig rig;  // a free pendulum
  for (auto& drive : rig.drives) drive.present = false;
  rig.start = {.trolley_m = 0, .radial_rad = 0.3};
  Bench bench{rig};
  bench.open_brakes();
  bench.tick({5, 5, 5}, true, 50);
  EXPECT_EQ(bench.board.truth().trolley_m, 0);
  EXPECT_EQ(bench.board.truth().slew_rad, 0);
  EXPECT_NE(bench.board.truth().radial_rad, 0.3);
}

TEST(Drives, WorkAloneWithoutALoad) {
  SimulatedRig rig;
  rig.parameters.load_mass_kg = 0;
  Bench bench{rig};
  bench.open_brakes();
  const double start = bench.board.truth().trolley_m;
  bench.board.kick(1, 1);  // nothing hangs there
  bench.tick({1, 0, 0}, true, 10);
  EXPECT_NEAR(bench.board.truth().trolley_m - start, 0.01, 1e-4);
  EXPECT_EQ(bench.board.truth().radial_rad, 0);
}

TEST(Kick, AddsToTheSwingRatesThatExist) {
  SimulatedRig rig;
  rig.tangential_swing = false;
  SimulatedBoard board{rig};
  EXPECT_TRUE(board.kick(0.2, 0.3));
  EXPECT_EQ(board.truth().radial_radps, 0.2);
  EXPECT_EQ(board.truth().tangential_radps, 0);
}

// --- time and errors
// --------------------------------------------------------------------------------------------

TEST(Time, OfTheRigDoesNotRunBackwards) {
  SimulatedBoard board{{}, 5 * kTick_ns};
  board.advance_to(kTick_ns);
  EXPECT_EQ(board.now_ns(), 5 * kTick_ns);
}

TEST(SimulatedBoard, GivesTheSameBitsForTheSameCalls) {
  SimulatedRig rig;
  rig.terms = test::rig_friction();
  const auto run = [&rig] {
    Bench bench{rig};
    bench.open_brakes();
    for (int i = 0; i < 200; ++i) {
      bench.tick({3 * std::sin(0.05 * i), 2 * std::cos(0.03 * i), 0.5}, true);
      if (i == 60) bench.board.kick(0.1, -0.2);
    }
    bench.tick({}, false, 50);
    return bench.board.truth();
  };
  EXPECT_EQ(run(), run());
}

TEST(SimulatedRig, ReportsAllItsProblemsAtOnce) {
  SimulatedRig rig;
  rig.parameters.load_mass_kg = -1;
  rig.terms = {{"phlogiston", "", {}}};
  rig.drives[1].sign = 0;
  rig.encoders[4].counts_per_unit = 0;
  rig.start.cable_m = kNan;
  try {
    const SimulatedBoard board{rig};
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    for (const char* part : {"load_mass_kg = -1", "phlogiston", "drives.slew.sign = 0",
                             "encoders.tangential.counts_per_unit = 0", "start.cable_m = nan"}) {
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  }
}

}  // namespace
}  // namespace crane::simulator
