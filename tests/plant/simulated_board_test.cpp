// Measurements, converters and permitted motion of the simulated board.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "board_bench.hpp"
#include "closed_loop.hpp"

namespace crane::simulator {
namespace {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Converter, CodesAreInvertedOffsetBinaryClampedToThirteenBits) {
  EXPECT_EQ(converter_code(0), 0x1000);
  EXPECT_EQ(converter_code(10), 0);
  EXPECT_EQ(converter_code(11), 0);
  EXPECT_EQ(converter_code(-10), 0x1FFF);  // clamped, never wrapped to +10 V
  EXPECT_EQ(converter_code(-1e300), 0x1FFF);
  EXPECT_EQ(converter_code(5), 0x800);
  EXPECT_EQ(converter_code(-5), 0x1800);
}

TEST(Converter, OutputsVoltagesWithinHalfAStepOfTheCommand) {
  constexpr double kStep_v = 20.0 / 8192;
  for (double v = -9.99; v < 10; v += 0.0137) {
    EXPECT_LE(std::abs(converter_voltage_v(converter_code(v)) - v), kStep_v / 2 + 1e-12) << v;
  }
  EXPECT_DOUBLE_EQ(converter_voltage_v(0), 10);
  EXPECT_DOUBLE_EQ(converter_voltage_v(0x1FFF), -10 + kStep_v);
}

TEST(Converter, GivesZeroVoltsForNaN) {
  Bench bench;
  bench.tick({kNan, kInfinity, -kInfinity}, false);
  EXPECT_EQ(bench.applied_v, (std::array<double, 3>{0, 0, 0}));
}

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
  // the swinging load may briefly move the trolley away from the stop
  EXPECT_NEAR(bench.board.truth().trolley_m, 0.45, 0.02);
  EXPECT_LE(bench.board.truth().trolley_m, 0.45);
  bench.tick({-2, 0, 0}, true, 100);
  EXPECT_TRUE(bench.board.read().limit_low[0]);
  EXPECT_FALSE(bench.board.read().limit_high[0]);
  EXPECT_GE(bench.board.truth().trolley_m, 0.15);
}

TEST(Travel, AStopRemovesMotionAndNeverAddsIt) {
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
  bench.board.kick(1, 1);  // there is no load
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
