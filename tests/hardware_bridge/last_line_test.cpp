// The bridge's own decision, hazard by hazard: what goes wrong, when it is stopped, and why. Each timeline is
// also run with its check taken away, and has to go unnoticed then: no check is there for nothing, and none
// stands in for another.
#include "crane/bridge/last_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "subject.hpp"

namespace crane::bridge::test {
namespace {

constexpr double kPeriod_s = 0.01;

const runtime::Rig& tower() {
  static const auto rig = emulated_rig();
  return rig;
}

/// A trolley, its brakes and its supervisor, tick by tick. Tests spoil one of the public numbers.
class Timeline {
 public:
  explicit Timeline(std::span<const Check> checks = last_line_checks())
      : line{last_line_parameters(tower()), checks}, checks_{checks} {
    tick();
  }

  double trolley_m = 0.6, speed_mps = 0;
  double swing_rad = 0;
  std::array<double, kDrives> drive_v{};
  bool release = true, permission = true, commands_come = true;
  bool encoder_dead = false, brake_opens = true;
  double encoder_offset_m = 0;
  double converter_gives = 1;  ///< times the volts asked for
  double converter_stuck_v = 0;
  bool limit_high = false;

  /// Elsewhere, as a new line that has seen nothing yet.
  void start_at(double position_m) {
    line = LastLine{last_line_parameters(tower()), checks_};
    outputs = {};
    trolley_m = position_m;
    tick();
  }
  /// @return true while the last line lets the command through
  bool tick(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) step();
    return line.reason() == Reason::none;
  }
  /// Ticks until it stops the crane; `most` when it does not.
  int ticks_until_stopped(int most = 50) {
    for (int i = 1; i <= most; ++i)
      if (!tick()) return i;
    return most;
  }
  void expect_safe() {
    EXPECT_EQ(outputs.drive_v, kNothing);
    EXPECT_EQ(outputs.brake_release, (std::array<bool, kDrives>{}));
    tick();
    EXPECT_FALSE(outputs.watchdog_level) << "toggles on";
    tick();
    EXPECT_FALSE(outputs.watchdog_level) << "toggles on";
  }

  LastLine line;
  Outputs outputs;
  std::optional<CommandView> command;
  std::uint64_t now = 0;

 private:
  void step() {
    ++now;
    if (commands_come) command = CommandView{now - 1, drive_v, {release, release, release}, permission};
    move();
    Seen seen;
    if (!encoder_dead) shown_m_ = trolley_m + encoder_offset_m;
    seen.coordinate = {shown_m_, 0, 1, swing_rad, 0};
    seen.counts[0] = std::llround(shown_m_ * tower().encoders[0].counts_per_unit);
    seen.applied_v = outputs.drive_v;
    const bool open = brake_opens && outputs.brake_release[0];
    seen.brake_closed = {!open, !open, !open};
    seen.limit_high[0] = limit_high;
    outputs = line.decide(command, now, seen);
  }
  /// Without friction; an open brake lets the trolley run.
  void move() {
    const bool open = brake_opens && outputs.brake_release[0];
    if (open)
      speed_mps += 2 * (outputs.drive_v[0] * converter_gives + converter_stuck_v) * kPeriod_s;
    else if (!slips)
      speed_mps = 0;
    trolley_m += speed_mps * kPeriod_s;
  }

 public:
  bool slips = false;

 private:
  double shown_m_ = 0.6;
  std::span<const Check> checks_;
};

struct Hazard {
  const char* name;
  Reason reason;
  int longest_ticks;  ///< from its begin until the outputs are safe
  std::function<void(Timeline&)> begin;
  /// Runs on; the first of these ticks is the first one spoilt.
  std::function<void(Timeline&, int)> every_tick = [](Timeline&, int) {};
  double trolley_m = 0.6;
  friend std::ostream& operator<<(std::ostream& out, const Hazard& hazard) { return out << hazard.name; }
};

const double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<Hazard> hazards() {
  return {
      {"SupervisorIsSilent", Reason::command_stale, 5, [](Timeline& t) { t.commands_come = false; }},
      {"CommandIsNotANumber", Reason::command_not_finite, 1, [](Timeline& t) { t.drive_v[1] = kNan; }},
      {"CommandIsInfinite", Reason::command_not_finite, 1,
       [](Timeline& t) { t.drive_v[1] = std::numeric_limits<double>::infinity(); }},
      {"CommandIsBeyondTheDrive", Reason::command_range, 1,
       [](Timeline& t) {
         t.drive_v[2] = 9;
         t.tick();
         t.drive_v[2] = 10.5;
       }},
      {"CommandJumps", Reason::command_rate, 1,
       [](Timeline& t) {
         t.drive_v[1] = -9;
         t.tick();
         t.drive_v[1] = 9;  // 18 V within a tick of 10 ms and 1000 V/s
       }},
      {"AxisRunsIntoItsLimit", Reason::position, 25, [](Timeline& t) { t.drive_v[0] = 3; },
       [](Timeline&, int) {}, 1.2},
      {"AxisIsTooFast", Reason::speed, 2, [](Timeline&) {},
       [](Timeline& t, int tick) { t.speed_mps = tick == 0 ? 1.8 : 0; }},
      {"LoadSwingsTooFar", Reason::swing, 20, [](Timeline&) {},
       [](Timeline& t, int) { t.swing_rad += 0.08; }},
      {"EncoderJumps", Reason::encoder_jump, 1, [](Timeline& t) { t.swing_rad = 0.5; }},
      {"SwitchClosesFarFromTheLimit", Reason::lost_counts, 1, [](Timeline& t) { t.limit_high = true; }},
      {"BrakeDoesNotHold", Reason::braked_motion, 30,
       [](Timeline& t) {
         t.release = false;
         t.tick(20);
         t.slips = true;
       },
       [](Timeline& t, int) { t.speed_mps = 0.15; }},
      {"EncoderIsDead", Reason::encoder_frozen, 11,
       [](Timeline& t) {
         t.encoder_dead = true;
         t.drive_v[0] = 6;
       }},
      {"ConverterIsWiredTheWrongWayRound", Reason::drive_response, 11,
       [](Timeline& t) {
         t.converter_gives = -1;
         t.drive_v[0] = 3;
       }},
      {"ConverterIsStuck", Reason::drive_response, 11, [](Timeline& t) { t.converter_stuck_v = 5; }},
  };
}

class LastLineHazard : public testing::TestWithParam<Hazard> {
 protected:
  /// Ordinary ticks, then the hazard. @return ticks from its begin until the crane was stopped, -1: it was
  /// not
  static int run(Timeline& timeline, const Hazard& hazard) {
    timeline.start_at(hazard.trolley_m);
    EXPECT_TRUE(timeline.tick(40)) << name_of(timeline.line.reason());
    hazard.begin(timeline);
    EXPECT_EQ(timeline.line.reason(), Reason::none) << "stopped before the hazard";
    for (int i = 0; i < 40; ++i) {
      hazard.every_tick(timeline, i);
      if (!timeline.tick()) return i + 1;
    }
    return -1;
  }
};

TEST_P(LastLineHazard, IsStoppedInTimeForItsReasonAndForGood) {
  const auto& hazard = GetParam();
  Timeline timeline;
  const int taken = run(timeline, hazard);
  EXPECT_GT(taken, 0) << "never stopped";
  EXPECT_LE(taken, hazard.longest_ticks);
  EXPECT_EQ(timeline.line.reason(), hazard.reason) << name_of(timeline.line.reason());
  timeline.expect_safe();
  timeline.drive_v = {};
  timeline.commands_come = true;
  timeline.tick(100);
  EXPECT_EQ(timeline.line.reason(), hazard.reason) << "a hazard that passes must not restart anything";
}

TEST_P(LastLineHazard, WithoutItsCheckIsNotStoppedForThatReasonNorInTime) {
  const auto& hazard = GetParam();
  std::vector<Check> others;
  std::ranges::copy_if(last_line_checks(), std::back_inserter(others),
                       [&hazard](const Check& check) { return check.reason != hazard.reason; });
  Timeline timeline{others};
  const int taken = run(timeline, hazard);
  EXPECT_TRUE(taken < 0 || taken > hazard.longest_ticks)
      << "stopped by " << name_of(timeline.line.reason()) << " after " << taken << " ticks";
}

INSTANTIATE_TEST_SUITE_P(Each, LastLineHazard, testing::ValuesIn(hazards()),
                         [](const auto& test) { return std::string{test.param.name}; });

TEST(LastLine, EveryCheckHasATimelineThatNeedsIt) {
  const auto all = hazards();
  for (const auto& check : last_line_checks())
    EXPECT_TRUE(std::ranges::any_of(all, [&](const Hazard& hazard) { return hazard.reason == check.reason; }))
        << name_of(check.reason);
}

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

TEST(LastLine, HoldsTheLastCommandForFiveTicksThenStopsForGood) {
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

TEST(LastLine, IsReleasedByPermissionWithheldAndThenGrantedWithNothingElseAsked) {
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

TEST(LastLine, IsNotReleasedByAnythingWhenThePositionIsUnknown) {
  Timeline timeline;
  timeline.tick(5);
  timeline.encoder_offset_m = 0.1;
  EXPECT_FALSE(timeline.tick());
  timeline.release = timeline.permission = false;
  timeline.tick(5);
  timeline.permission = true;
  EXPECT_FALSE(timeline.tick(5));
}

TEST(LastLine, StopsADriveAtFullSpeedByTheBrakeBeforeItsLimit) {
  const auto& rig = tower();
  const std::vector<Check> only_position{
      last_line_checks()[6]};  // the others mind where that speed comes from
  ASSERT_EQ(only_position[0].reason, Reason::position);
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

TEST(LastLine, LetsAnEncoderStandStillWhileTheDrivePushesLessThanFrictionMayHold) {
  Timeline timeline;
  timeline.encoder_dead = true;
  timeline.drive_v[0] = 4.5;  // friction of the rig file: 1.2 V, trip above 3 + 1.5 * 1.2
  EXPECT_TRUE(timeline.tick(40)) << name_of(timeline.line.reason());
}

TEST(LastLine, DoesNotMistakeABrakeThatStopsAnAxisForADriveThatPushesIt) {
  for (const double volts : {6.0, -6.0}) {
    Timeline timeline;
    timeline.drive_v[0] = volts;
    timeline.tick(8);
    timeline.drive_v[0] = 0;
    timeline.release = false;  // this timeline's brake stops the axis dead within the tick
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

}  // namespace
}  // namespace crane::bridge::test
