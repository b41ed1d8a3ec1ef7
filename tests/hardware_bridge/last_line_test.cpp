// LastLine: permitted commands, their duration, and the end of a latch.
#include <gtest/gtest.h>

#include <vector>

#include "crane/configuration/encoder_resolution.hpp"
#include "last_line_timeline.hpp"

namespace crane::bridge::test {
namespace {

TEST(LastLine, IsSafeBeforeTheFirstCommand) {
  LastLine line{last_line_parameters(tower())};
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    const auto outputs = line.decide(std::nullopt, tick, {});
    EXPECT_EQ(outputs.drive_v, kNothing);
    EXPECT_EQ(outputs.brake_release, (std::array<bool, kDrives>{}));
    EXPECT_FALSE(outputs.watchdog_level);
  }
  EXPECT_EQ(line.reason(), Reason::none);
}

TEST(LastLine, PassesAFreshCommandAndTogglesTheWatchdog) {
  Timeline timeline;
  timeline.drive_v = {3, -2, 0};
  timeline.tick(5);
  EXPECT_EQ(timeline.outputs.drive_v, timeline.drive_v);
  const bool level = timeline.outputs.watchdog_level;
  timeline.tick();
  EXPECT_NE(timeline.outputs.watchdog_level, level);
}

TEST(LastLine, HoldsTheLastCommandForFiveTicksThenLatches) {
  Timeline timeline;
  timeline.drive_v = {3, 0, 0};
  timeline.tick(5);
  timeline.commands_come = false;
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(timeline.tick());
    EXPECT_EQ(timeline.outputs.drive_v[0], 3) << i;
  }
  EXPECT_FALSE(timeline.tick());
  timeline.commands_come = true;
  EXPECT_FALSE(timeline.tick(10)) << "commands that come back do not restart motion";
}

TEST(LastLine, IsReleasedByAnEarlierResetAfterTheSecondWriterHasGone) {
  Timeline timeline;
  timeline.tick(5);
  timeline.second_writer = true;
  timeline.tick();
  timeline.release = timeline.permission = false;
  timeline.tick(10);
  timeline.permission = true;
  EXPECT_FALSE(timeline.tick(10)) << "the second writer is present";
  timeline.second_writer = false;
  EXPECT_TRUE(timeline.tick());
}

TEST(LastLine, IsReleasedByPermissionThatIsWithheldAndThenGranted) {
  Timeline timeline;
  timeline.tick(5);
  timeline.commands_come = false;
  timeline.tick(10);
  timeline.commands_come = true;
  timeline.release = false;
  EXPECT_FALSE(timeline.tick()) << "permission alone is no reset";
  timeline.permission = false;
  timeline.tick();
  timeline.permission = timeline.release = true;
  EXPECT_FALSE(timeline.tick()) << "a command to move is no reset";
  timeline.release = false;
  EXPECT_TRUE(timeline.tick());
  timeline.release = true;
  EXPECT_TRUE(timeline.tick());
  EXPECT_TRUE(timeline.outputs.brake_release[0]);
}

TEST(LastLine, IsNeverReleasedWhenThePositionIsUnknown) {
  Timeline timeline;
  timeline.tick(5);
  timeline.encoder_offset_m = 0.1;
  EXPECT_FALSE(timeline.tick());
  timeline.release = timeline.permission = false;
  timeline.tick(5);
  timeline.permission = true;
  EXPECT_FALSE(timeline.tick(5));
}

TEST(LastLine, ATickThatWasLatchedLateIsNoOverspeed) {
  Timeline timeline;
  timeline.start_at(0.3);
  timeline.speed_mps = 1.4;  // max_speed is 1.5 m/s
  for (int i = 0; i < 30; ++i) {
    timeline.late_s = i % 3 == 1 ? 0.005 : 0;
    timeline.encoder_offset_m = timeline.late_s * timeline.speed_mps;
    ASSERT_TRUE(timeline.tick()) << name_of(timeline.line.reason()) << ", tick " << i;
  }
}

TEST(LastLine, StopsADriveAtFullSpeedByTheBrakeBeforeItsLimit) {
  const auto& rig = tower();
  std::vector<Check> only_position;  // the other checks would detect the cause of this speed
  std::ranges::copy_if(last_line_checks(), std::back_inserter(only_position),
                       [](const Check& check) { return check.reason == Reason::position; });
  ASSERT_EQ(only_position.size(), 1U);
  for (const double speed_mps : {0.2, 0.7, 1.4}) {
    Timeline timeline{only_position};
    timeline.tick(5);
    timeline.speed_mps = speed_mps;
    timeline.ticks_until_stopped(500);
    ASSERT_EQ(timeline.line.reason(), Reason::position);
    const double way_m = speed_mps * 0.02 + speed_mps * speed_mps / (2 * 20.0);
    EXPECT_LE(timeline.trolley_m + way_m, rig.drives[0].high_limit + speed_mps * kPeriod_s) << speed_mps;
    EXPECT_GT(timeline.trolley_m + way_m, rig.drives[0].high_limit) << "not before it is necessary";
  }
}

TEST(LastLine, PermitsAConstantEncoderWhileFrictionMayHoldTheDrive) {
  Timeline timeline;
  timeline.encoder_dead = true;
  // Friction of the rig file: 1.2 V. With 0.5 V, half of the friction and 0.3 V of the load: 2.6 V.
  timeline.drive_v[0] = 2.5;
  EXPECT_TRUE(timeline.tick(40)) << name_of(timeline.line.reason());
}

TEST(LastLine, DoesNotMistakeABrakeThatStopsAnAxisForADriveThatPushesIt) {
  for (const double volts : {6.0, -6.0}) {
    Timeline timeline;
    timeline.drive_v[0] = volts;
    timeline.tick(8);
    timeline.drive_v[0] = 0;
    timeline.release = false;  // the brake of this timeline stops the axis within the tick
    EXPECT_TRUE(timeline.tick(60)) << name_of(timeline.line.reason());
  }
}

TEST(LastLine, DoesNotMistakeASkippedTickForAJumpOrForSpeed) {
  Timeline timeline;
  timeline.drive_v[0] = 5;
  timeline.tick(14);  // 1.3 m/s
  timeline.drive_v[0] = 0;
  timeline.now += 3;
  timeline.trolley_m += 3 * timeline.speed_mps * kPeriod_s;
  EXPECT_TRUE(timeline.tick()) << name_of(timeline.line.reason());
}

/// The tower with an encoder of the trolley that is as coarse as the rig reader permits.
configuration::Rig tower_with_coarse_encoder() {
  auto rig = tower();
  rig.encoders[0].counts_per_unit = configuration::least_counts_per_unit(rig.drives[0], rig.period_s);
  return rig;
}

TEST(LastLine, DoesNotMistakeACoarseEncoderForADeadOneWhileTheAxisReverses) {
  for (const double omega_radps : {8.0, 12.0, 20.0})
    for (const double volts : {3.5, 4.5, 5.5}) {
      const auto rig = tower_with_coarse_encoder();
      Timeline timeline{last_line_checks(), rig};
      timeline.start_at(0.5);
      for (int k = 0; k < 1000; ++k) {
        timeline.drive_v[0] = volts * std::cos(omega_radps * k * kPeriod_s);
        ASSERT_TRUE(timeline.tick()) << name_of(timeline.line.reason()) << " in tick " << k << ", " << volts
                                     << " V, " << omega_radps << " rad/s";
      }
    }
}

TEST(LastLine, DetectsADeadCoarseEncoder) {
  const auto rig = tower_with_coarse_encoder();
  Timeline timeline{last_line_checks(), rig};
  timeline.tick(5);
  timeline.encoder_dead = true;
  timeline.drive_v[0] = 6;
  EXPECT_LE(timeline.ticks_until_stopped(), 11);
  EXPECT_EQ(timeline.line.reason(), Reason::encoder_frozen);
}

TEST(LastLine, TheForceOfALoadAsHeavyAsTheTrolleyIsNoFaultOfItsDrive) {
  auto heavy = tower();
  heavy.design.crane.load_mass_kg = heavy.design.crane.trolley_inertia_kg;
  constexpr double kForce_v = 3.1;  // m g sin(0.7 rad) / (M K) is 3.16 V
  Timeline loaded{last_line_checks(), heavy}, light;
  for (auto* timeline : {&loaded, &light}) timeline->tick(40);
  loaded.converter_stuck_v = light.converter_stuck_v = kForce_v;  // accelerates the trolley without a command
  EXPECT_TRUE(loaded.tick(11)) << name_of(loaded.line.reason());
  light.tick(11);
  EXPECT_EQ(light.line.reason(), Reason::drive_response) << "a load of 2 kg cannot do this";
}

}  // namespace
}  // namespace crane::bridge::test
