// The supervisor detects a bridge that executes commands of another program.
#include "process/command_echo.hpp"

#include <gtest/gtest.h>

namespace crane::supervisor {
namespace {

/// A supervisor and a bridge that executes its command one tick later, unless a test changes the reported
/// state.
class Echo : public testing::Test {
 protected:
  msg::State report() const {
    msg::State state{};
    state.header.tick = tick_ + 1;
    state.applied_command_tick = tick_;
    state.applied_v[0] = volts_;
    for (std::size_t i = 0; i < 3; ++i) state.brake_closed[i] = !released_;
    return state;
  }
  void command(double trolley_v, bool release) {
    msg::Command command{};
    command.header.tick = ++tick_;
    command.drive_v[0] = volts_ = trolley_v;
    for (bool& brake : command.brake_release) brake = released_ = release;
    echo_.commanded(command);
  }
  /// @return number of states until the detection; 0: not detected
  int noticed_after(const msg::State& state, int most = 100) {
    for (int i = 1; i <= most; ++i)
      if (echo_.contradicts(state)) return i;
    return 0;
  }

  CommandEcho echo_{{true, true, true}, 0.01};
  std::uint64_t tick_ = 100;
  double volts_ = 0;
  bool released_ = false;
};

TEST_F(Echo, AcceptsABridgeThatObeys) {
  for (int i = 0; i < 500; ++i) {
    command(i < 250 ? 0.04 * i : 0, i < 250);
    ASSERT_FALSE(echo_.contradicts(report())) << i;
  }
}

TEST_F(Echo, AcceptsAnOldCommandAndZeroVolts) {
  command(5, true);
  const auto old = report();
  command(0, true);
  EXPECT_EQ(noticed_after(old, 5), 0);
  auto latched = report();
  latched.applied_v[0] = 0;
  EXPECT_EQ(noticed_after(latched, 5), 0);
}

TEST_F(Echo, AcceptsTheCommandsOfAnEarlierSupervisor) {
  auto state = report();
  state.applied_v[0] = 5;
  EXPECT_EQ(noticed_after(state), 0) << "nothing commanded yet";
  command(0, false);
  state.applied_command_tick = 90;
  EXPECT_EQ(noticed_after(state, 5), 0);
}

TEST_F(Echo, DetectsUncommandedVoltsAtTheSecondState) {
  command(0, false);
  auto state = report();
  state.applied_v[1] = -0.2;
  EXPECT_EQ(noticed_after(state), CommandEcho::kContradictions);
}

TEST_F(Echo, DetectsVoltsOfACommandThatWasNeverSent) {
  command(5, true);
  auto state = report();
  state.applied_command_tick += 3;
  EXPECT_EQ(noticed_after(state), CommandEcho::kContradictions);
}

TEST_F(Echo, DetectsABrakeThatIsOpenWithoutARelease) {
  command(0, false);
  auto state = report();
  state.brake_closed[2] = false;
  EXPECT_EQ(noticed_after(state), 0) << "it may still be closing";
  for (std::uint64_t i = 0; i <= ticks_in(CommandEcho::kBrake_s, 0.01); ++i) command(0, false);
  state = report();
  state.brake_closed[2] = false;
  EXPECT_EQ(noticed_after(state), CommandEcho::kContradictions);
}

TEST_F(Echo, IgnoresTheBrakesOfAbsentDrives) {
  CommandEcho echo{{true, true, false}, 0.01};
  msg::Command command{};
  echo.commanded(command);
  msg::State state{};
  state.header.tick = 1000;
  state.brake_closed[0] = state.brake_closed[1] = true;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(echo.contradicts(state));
}

TEST_F(Echo, AcceptsEachCommandOfATickWithTwoCommands) {
  command(4, true);
  msg::Command again{};
  again.header.tick = tick_;
  echo_.commanded(again);
  EXPECT_EQ(noticed_after(report()), 0);
}

/// The durations hold for a period of 1 ms, too.
class FastEcho : public Echo {
 protected:
  FastEcho() { echo_ = CommandEcho{{true, true, true}, 0.001}; }
};

TEST_F(FastEcho, AcceptsACommandOfTheLargestPermittedAge) {
  command(5, true);
  const auto old = report();
  for (int i = 0; i < 100; ++i) command(0, true);
  EXPECT_EQ(noticed_after(old, 5), 0);
}

TEST_F(FastEcho, AcceptsABrakeThatClosesWithin200Milliseconds) {
  command(0, true);
  for (int i = 0; i < 200; ++i) {
    command(0, false);
    auto closing = report();
    closing.brake_closed[0] = false;
    ASSERT_FALSE(echo_.contradicts(closing)) << i << " ms";
  }
}

}  // namespace
}  // namespace crane::supervisor
