// Detection time and reason of LastLine for each fault. Each timeline also runs without the check of its
// fault and must then not be stopped, which proves that every check is necessary.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "last_line_timeline.hpp"

namespace crane::bridge::test {
namespace {

struct Fault {
  const char* name;
  Reason reason;
  int longest_ticks;  ///< from the onset until the outputs are safe
  std::function<void(Timeline&)> begin;
  /// Continues the run with the fault from the first of these ticks on.
  std::function<void(Timeline&, int)> every_tick = [](Timeline&, int) {};
  double trolley_m = 0.6;
  friend std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }
};

const double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<Fault> faults() {
  return {
      {"SupervisorIsSilent", Reason::command_stale, 5, [](Timeline& t) { t.commands_come = false; }},
      {"CommandHasASecondWriter", Reason::second_writer, 1, [](Timeline& t) { t.second_writer = true; }},
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
      {"AxisWithUnknownPositionIsReleased", Reason::not_homed, 1, [](Timeline& t) { t.unknown = true; }},
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

class LastLineFault : public testing::TestWithParam<Fault> {
 protected:
  /// Runs ordinary ticks, then the fault. @return ticks from the onset of the fault to the stop; -1: no stop
  static int run(Timeline& timeline, const Fault& fault) {
    timeline.start_at(fault.trolley_m);
    EXPECT_TRUE(timeline.tick(40)) << name_of(timeline.line.reason());
    fault.begin(timeline);
    EXPECT_EQ(timeline.line.reason(), Reason::none) << "stopped before the fault";
    for (int i = 0; i < 40; ++i) {
      fault.every_tick(timeline, i);
      if (!timeline.tick()) return i + 1;
    }
    return -1;
  }
};

TEST_P(LastLineFault, IsStoppedInTimeForItsReasonAndRemainsStopped) {
  const auto& fault = GetParam();
  Timeline timeline;
  const int taken = run(timeline, fault);
  EXPECT_GT(taken, 0) << "never stopped";
  EXPECT_LE(taken, fault.longest_ticks);
  EXPECT_EQ(timeline.line.reason(), fault.reason) << name_of(timeline.line.reason());
  timeline.expect_safe();
  timeline.drive_v = {};
  timeline.commands_come = true;
  timeline.tick(100);
  EXPECT_EQ(timeline.line.reason(), fault.reason) << "a fault that passes must not restart anything";
}

TEST_P(LastLineFault, WithoutItsCheckIsStoppedLateOrNot) {
  const auto& fault = GetParam();
  std::vector<Check> others;
  std::ranges::copy_if(last_line_checks(), std::back_inserter(others),
                       [&fault](const Check& check) { return check.reason != fault.reason; });
  Timeline timeline{others};
  const int taken = run(timeline, fault);
  EXPECT_TRUE(taken < 0 || taken > fault.longest_ticks)
      << "stopped by " << name_of(timeline.line.reason()) << " after " << taken << " ticks";
}

INSTANTIATE_TEST_SUITE_P(Each, LastLineFault, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string{test.param.name}; });

TEST(LastLine, EveryCheckHasATimelineThatNeedsIt) {
  const auto all = faults();
  for (const auto& check : last_line_checks())
    EXPECT_TRUE(std::ranges::any_of(all, [&](const Fault& fault) { return fault.reason == check.reason; }))
        << name_of(check.reason);
}

}  // namespace
}  // namespace crane::bridge::test
