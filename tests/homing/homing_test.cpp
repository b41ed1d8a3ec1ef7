/// A crane whose positions are unknown at power-on determines them, and moves at homing speed until then.
#include <gmock/gmock.h>

#include <cmath>

#include "crane/plant/coordinates.hpp"

#include "lockstep_crane.hpp"

namespace crane::homing_test {
namespace {

using testing::HasSubstr;

class HomingOn : public testing::TestWithParam<const char*> {};

TEST_P(HomingOn, FindsEveryZeroAndPermitsMovesOnlyAfterwards) {
  const auto rig = homing_rig();
  LockstepCrane crane{GetParam()};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FALSE(crane.state().position_known[i]);
    EXPECT_GT(std::abs(crane.shown(i) - crane.truth(i)), 0.1) << "the bridge must not know where it starts";
  }
  ASSERT_EQ(crane.ask(crane_REQUEST_RESET), "");
  crane.run(1.1);
  EXPECT_THAT(crane.ask(crane_REQUEST_ARM), HasSubstr("crane home"));
  EXPECT_THAT(crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {1, 0, 0}}),
              HasSubstr("crane home"));
  for (const std::size_t axis : {2U, 0U, 1U}) {
    const std::array before{crane.truth(0), crane.truth(1), crane.truth(2)};
    double last = crane.truth(axis), fastest = 0, most_v = 0;
    crane.every_tick = [&] {
      const double now = crane.truth(axis);
      fastest = std::max(fastest, std::abs(now - last) / rig.period_s);
      most_v = std::max(most_v, std::abs(crane.crane().converter_v()[axis]));
      last = now;
    };
    crane.home_completely(axis);
    crane.every_tick = [] {};
    const auto& homing = rig.drives[axis].homing;
    EXPECT_LE(fastest, 2.5 * homing.speed) << axis;
    EXPECT_LE(most_v, homing.volt_limit_v) << axis;
    const double half_a_tick = homing.approach_speed * rig.period_s / 2;
    EXPECT_NEAR(crane.shown(axis), crane.truth(axis), half_a_tick + 2 / rig.encoders[axis].counts_per_unit)
        << axis;
    RecordProperty(plant::kCoordinates[axis].name, std::to_string(crane.shown(axis) - crane.truth(axis)));
    for (std::size_t other = 0; other < 3; ++other) {
      if (other == axis) continue;
      EXPECT_NEAR(crane.truth(other), before[other], 1e-9) << "moved while " << axis << " was homed";
    }
  }
  crane.arm();
  ASSERT_EQ(crane.status().state, crane_STATE_HOLD) << supervisor::name_of(crane.cause());
  EXPECT_THAT(
      crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {1.44, 0, 0}}),
      HasSubstr("must lie in"))
      << "limits are in force";
  EXPECT_EQ(
      crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, true, true}, .target = {1.0, -0.5, 0.8}}),
      "");
  crane.run(12);
  EXPECT_EQ(crane.status().state, crane_STATE_HOLD) << supervisor::name_of(crane.cause());
  EXPECT_NEAR(crane.truth(0), 1.0, 0.01);
  EXPECT_NEAR(crane.truth(1), -0.5, 0.02);
  EXPECT_NEAR(crane.truth(2), 0.8, 0.01);
}

/// The swing feedback must not make the approach faster than the speed that the bridge accepts.
TEST_P(HomingOn, SucceedsWithTheFeedbackOfEveryController) {
  for (const auto& controller : control::controllers()) {
    auto rig = homing_rig();
    rig.controller = controller.name;
    LockstepCrane crane{GetParam(), rig, rig};
    for (const std::size_t axis : {2U, 0U, 1U}) {
      crane.home_completely(axis);
      if (HasFatalFailure()) FAIL() << controller.name;
      EXPECT_NEAR(crane.shown(axis), crane.truth(axis), 5e-4) << controller.name << ", axis " << axis;
    }
  }
}

TEST_P(HomingOn, BeginsAlsoAtTheMark) {
  auto rig = homing_rig();
  rig.start.position = {0.055, 0.09, 0.45};  // starts near the switch, or below the mark
  LockstepCrane crane{GetParam(), rig, rig};
  for (const std::size_t axis : {0U, 1U}) {
    crane.home_completely(axis);
    EXPECT_NEAR(crane.shown(axis), crane.truth(axis), 2e-4) << axis;
  }
}

TEST_P(HomingOn, OfTwoAxesInOneTickHomesTheFirstAndRefusesTheSecond) {
  LockstepCrane crane{GetParam()};
  crane.run(1.1);
  ASSERT_EQ(crane.ask(crane_REQUEST_RESET), "");
  crane.run(1.1);
  stack::OperatorRequest hoist{.kind = crane_REQUEST_HOME}, trolley = hoist;
  hoist.selected[control::kHoist] = trolley.selected[control::kTrolley] = true;
  const auto reasons = crane.ask_at_once({hoist, trolley});
  EXPECT_EQ(reasons[0], "");
  EXPECT_NE(reasons[1].find("in this tick"), std::string::npos) << reasons[1];
  EXPECT_TRUE(crane.status().homing[control::kHoist]);
}

TEST_P(HomingOn, TwiceGivesTheSameZero) {
  LockstepCrane crane{GetParam()};
  crane.home_completely(0);
  const double first_m = crane.shown(0) - crane.truth(0);
  crane.begin_homing(0);
  EXPECT_FALSE(crane.state().position_known[0]) << "homing begins with an unknown position";
  crane.run_until([&] { return crane.status().state == crane_STATE_LOCKED; }, 60);
  crane.run(0.3);
  EXPECT_TRUE(crane.state().position_known[0]);
  EXPECT_NEAR(crane.shown(0) - crane.truth(0), first_m, 1e-4);
}

TEST_P(HomingOn, LostCountsMakeThePositionUnknownUntilHoming) {  // hazard 17
  LockstepCrane crane{GetParam()};
  for (const std::size_t axis : {2U, 0U, 1U}) crane.home_completely(axis);
  crane.arm();
  EXPECT_EQ(crane.ask({.kind = crane_REQUEST_MOVE, .selected = {false, true, false}, .target = {0, 0.35, 0}}),
            "");
  crane.run(5);
  double lost_counts = 0;  // the encoder slips by 0.1 rad in 20 s; no other check detects it
  crane.spoil = [&](bridge::Inputs& inputs, const plant::State&) {
    lost_counts = std::min(lost_counts + 2.9, 5730.0);
    inputs.raw_counts[1] += static_cast<std::int32_t>(lost_counts);
  };
  crane.run(21);
  stack::OperatorRequest to_and_fro{
      .kind = crane_REQUEST_FOLLOW, .selected = {false, true, false}, .target = {0, 0.35, 0}};
  to_and_fro.sines = {{0.4, 0.025, 0}};  // slow, so that the load is at rest when the brakes close
  to_and_fro.duration_s = 60;
  EXPECT_EQ(crane.ask(to_and_fro), "");
  crane.run_until([&] { return crane.status().state >= crane_STATE_STOP_C1; }, 60);
  EXPECT_EQ(crane.state().latch_reason, crane_LATCH_LOST_COUNTS) << "the mark at 0.1 rad is seen at 0.2";
  crane.run(0.5);
  EXPECT_TRUE(crane.safe());
  EXPECT_FALSE(crane.state().position_known[1]);
  EXPECT_TRUE(crane.state().position_known[0]) << "only one encoder has lost counts";
  crane.run(3);
  crane.home_completely(1);
  EXPECT_EQ(crane.state().latch_reason, crane_LATCH_NONE);
  EXPECT_NEAR(crane.shown(1), crane.truth(1), 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Board, HomingOn, testing::ValuesIn(kBoards),
                         [](const auto& test) { return test.param; });

TEST(HomingOnBothBoards, GivesTheSameZeroesToTheLastCount) {
  LockstepCrane simulated{"simulated"}, emulated{"emulated"};
  for (auto* crane : {&simulated, &emulated}) crane->home_completely(0);
  EXPECT_EQ(simulated.state().counts[0], emulated.state().counts[0]);
  EXPECT_EQ(simulated.truth(0), emulated.truth(0));
  EXPECT_EQ(simulated.state().header.tick, emulated.state().header.tick);
}

}  // namespace
}  // namespace crane::homing_test
