// The bridge's own decision: whatever the commands are, or when none come, the answer is safe.
#include "crane/bridge/last_line.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <tuple>

namespace crane::bridge {
namespace {

CommandView moving(std::uint64_t tick) {
  return {
      .tick = tick, .drive_v = {3, -2, 0}, .brake_release = {true, true, true}, .watchdog_permission = true};
}
CommandView quiet(std::uint64_t tick, bool permission) {
  return {.tick = tick, .watchdog_permission = permission};
}

void expect_safe(const Outputs& outputs) {
  EXPECT_EQ(outputs.drive_v, (std::array<double, kDrives>{}));
  EXPECT_EQ(outputs.brake_release, (std::array<bool, kDrives>{}));
  EXPECT_FALSE(outputs.watchdog_level);
}

TEST(LastLine, IsSafeBeforeTheFirstCommand) {
  LastLine line{{}};
  expect_safe(line.decide(std::nullopt, 0));
  EXPECT_FALSE(line.command_stale());
}

TEST(LastLine, PassesAFreshCommandAndTogglesTheWatchdog) {
  LastLine line{{}};
  const auto first = line.decide(moving(0), 1);
  const auto second = line.decide(moving(1), 2);
  EXPECT_EQ(first.drive_v, moving(0).drive_v);
  EXPECT_NE(first.watchdog_level, second.watchdog_level);
}

TEST(LastLine, HoldsTheLastCommandForFiveTicksThenStopsForGood) {
  LastLine line{{.stale_after_ticks = 5}};
  for (std::uint64_t tick = 1; tick <= 5; ++tick)
    EXPECT_EQ(line.decide(moving(0), tick).drive_v[0], 3) << tick;
  expect_safe(line.decide(moving(0), 6));
  EXPECT_TRUE(line.command_stale());
  expect_safe(line.decide(moving(6), 7));  // commands that come back do not restart motion
}

TEST(LastLine, RefusesWhatIsNotFiniteOrBeyondTheDrive) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 10.5, -10.5}) {
    LastLine line{{}};
    auto command = moving(0);
    command.drive_v[1] = bad;
    expect_safe(line.decide(command, 1));
    EXPECT_TRUE(line.command_invalid()) << bad;
    expect_safe(line.decide(moving(1), 2));
  }
}

TEST(LastLine, IsReleasedByPermissionWithheldAndThenGrantedWithNothingElseAsked) {
  LastLine line{{}};
  expect_safe(line.decide(moving(0), 100));
  std::ignore = line.decide(quiet(100, true), 101);
  EXPECT_TRUE(line.command_stale()) << "permission alone is no reset";
  std::ignore = line.decide(quiet(101, false), 102);
  std::ignore = line.decide(moving(102), 103);
  EXPECT_TRUE(line.command_stale()) << "a command to move is no reset";
  std::ignore = line.decide(quiet(103, true), 104);
  EXPECT_FALSE(line.command_stale());
  EXPECT_EQ(line.decide(moving(104), 105).drive_v[0], 3);
}

}  // namespace
}  // namespace crane::bridge
