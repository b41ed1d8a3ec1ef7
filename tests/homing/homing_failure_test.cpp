/// Every failure of homing ends with 0 V, closed brakes, a name, and an unknown position.
#include <gmock/gmock.h>

#include <cmath>

#include "lockstep_crane.hpp"

namespace crane::homing_test {
namespace {

using supervisor::Cause;

struct Fault {
  const char* name;
  Spoil spoil;
  Cause cause;
  crane_HomingFailure failure;
  crane_LatchReason latch = crane_LATCH_NONE;
  double trolley_m = 0.3;
  bool turned_round = false;  ///< drive and encoder with wrong sign: the loop is stable, and the axis moves
                              ///< in the other direction
};

std::vector<Fault> faults() {
  return {
      {"TheSwitchIsStuckClosed", [](bridge::Inputs& in, const auto&) { in.limit_low[0] = true; },
       Cause::homing_failed, crane_HOMING_MARK_STUCK},
      {"TheSwitchNeverClosesAndTheAxisMeetsItsEndStop",
       [](bridge::Inputs& in, const auto&) { in.limit_low[0] = false; }, Cause::homing_failed,
       crane_HOMING_NO_MOTION, crane_LATCH_NONE, 0.15},
      {"TheOtherSwitchIsReachedFirst",
       {},
       Cause::homing_failed,
       crane_HOMING_OTHER_SWITCH,
       crane_LATCH_NONE,
       1.35,
       true},
      {"TheEncoderIsDead",
       [shown = std::optional<std::int32_t>{}](bridge::Inputs& in, const auto&) mutable {
         if (!shown) shown = in.raw_counts[0];
         in.raw_counts[0] = *shown;
       },
       Cause::homing_failed, crane_HOMING_NO_MOTION},
      {"TheMarkIsSeenAtTwoPlaces",
       [sights = 0, was = false](bridge::Inputs& in, const plant::State& truth) mutable {
         const double mark_m = sights >= 1 ? 0.09 : 0.05;
         const bool closed = truth.trolley_m <= mark_m;
         sights += was && !closed ? 1 : 0;
         was = in.limit_low[0] = closed;
       },
       Cause::homing_failed, crane_HOMING_MARK_DISAGREES},
      {"TheEncoderFallsSilentAfterTheSecondDetection",
       [sights = 0, was = false, ticks = 0, shown = std::int32_t{0}](bridge::Inputs& in,
                                                                     const auto&) mutable {
         constexpr int kBeforeSilence = 30;
         sights += in.limit_low[0] && !was ? 1 : 0;
         was = in.limit_low[0];
         if (sights < 2 || ++ticks <= kBeforeSilence)
           shown = in.raw_counts[0];
         else
           in.raw_counts[0] = shown;
       },
       Cause::homing_failed, crane_HOMING_NO_MOTION},
  };
}

class HomingFault : public testing::TestWithParam<std::tuple<const char*, Fault>> {};

TEST_P(HomingFault, EndsSafeWithItsReasonAndAnUnknownPosition) {
  const auto& [board, fault] = GetParam();
  auto told = homing_rig(), wired = homing_rig();
  told.start.position[0] = wired.start.position[0] = fault.trolley_m;
  if (fault.turned_round) {
    wired.drives[0].sign = -1;
    wired.encoders[0].sign = -1;
    told.controller = "none";                  // anti-swing would excite the swing of a mirrored crane
    auto& friction = told.design.friction[0];  // friction of the other direction, which the mirrored axis has
    friction.coulomb_negative_v = friction.stiction_negative_v = friction.coulomb_positive_v;
    friction.viscous_negative_vspm = friction.viscous_positive_vspm;
  }
  LockstepCrane crane{board, told, wired};
  crane.spoil = fault.spoil;
  double most_m = 0;
  const double from_m = crane.truth(0);
  crane.every_tick = [&] { most_m = std::max(most_m, std::abs(crane.truth(0) - from_m)); };
  crane.begin_homing(0);
  crane.run_until([&] { return crane.status().state >= crane_STATE_STOP_C1; }, 60);
  EXPECT_EQ(crane.cause(), fault.cause) << supervisor::name_of(crane.cause());
  EXPECT_EQ(crane.status().homing_failure, fault.failure);
  EXPECT_EQ(crane.state().latch_reason, fault.latch);
  crane.run(0.5);
  EXPECT_TRUE(crane.safe());
  EXPECT_FALSE(crane.state().position_known[0]);
  RecordProperty("farthest_m", std::to_string(most_m));
  crane.run(1.2);
  crane.ask(crane_REQUEST_RESET);
  crane.run(1.2);
  EXPECT_NE(crane.ask(crane_REQUEST_ARM), "");
  EXPECT_TRUE(crane.safe());
}

INSTANTIATE_TEST_SUITE_P(Each, HomingFault,
                         testing::Combine(testing::ValuesIn(kBoards), testing::ValuesIn(faults())),
                         [](const auto& test) {
                           return std::string{std::get<0>(test.param)} + "_" + std::get<1>(test.param).name;
                         });

TEST(HomingFailureEvent, AppearsOnce) {
  LockstepCrane crane{"simulated"};
  crane.spoil = [](bridge::Inputs& in, const auto&) { in.limit_low[0] = in.limit_high[0] = true; };
  crane.run(1.1);
  ASSERT_EQ(crane.ask(crane_REQUEST_RESET), "");
  ASSERT_EQ(crane.home(0), "");
  crane.run(2);
  ASSERT_EQ(crane.status().state, crane_STATE_LOCKED);
  ASSERT_EQ(crane.cause(), Cause::homing_failed) << supervisor::name_of(crane.cause());
  EXPECT_EQ(crane.events("homing_failed"), 1);
}

class HomingInterrupted : public testing::TestWithParam<crane_RequestKind> {};

TEST_P(HomingInterrupted, LeavesThePositionUnknownAndCanBeRepeated) {
  auto rig = homing_rig();
  rig.start.position[0] = 0.2;
  LockstepCrane crane{"emulated", rig, rig};
  crane.begin_homing(0);
  crane.run(1);
  if (GetParam() == crane_REQUEST_KICK)
    crane.crane().press_estop(true);
  else
    EXPECT_EQ(crane.ask(GetParam()), "");
  crane.run(1);
  EXPECT_TRUE(crane.safe());
  EXPECT_FALSE(crane.state().position_known[0]);
  crane.crane().press_estop(false);
  crane.run(1.5);
  crane.home_completely(0);
}

std::string interruption_name(const testing::TestParamInfo<crane_RequestKind>& test) {
  return std::array{"Stop", "Disarm", "EstopRequest", "EstopButton"}.at(test.index);
}

INSTANTIATE_TEST_SUITE_P(By, HomingInterrupted,
                         testing::Values(crane_REQUEST_STOP, crane_REQUEST_DISARM, crane_REQUEST_ESTOP,
                                         crane_REQUEST_KICK),
                         interruption_name);

}  // namespace
}  // namespace crane::homing_test
