// Ends the process of a driver in every possible way. The rig is another process, whose time advances only on
// request, so that the test does not depend on the speed of the computer.
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <ctime>
#include <iostream>
#include <thread>

#include "crane/boards/linked_rig.hpp"
#include "crane/emulated_rig/rig_server.hpp"
#include "subject.hpp"

namespace crane::bridge::test {

using emulated_rig::RigServer;
namespace {

std::string unique_name(const std::string& part) {
  return "/crane_test_" + std::to_string(::getpid()) + "_" + part;
}

volatile std::sig_atomic_t throw_requested = 0;

/// A bridge without bus: 4 V on trolley and slew in every tick, brakes open, watchdog output toggling.
/// SIGUSR1 makes another thread throw an uncaught exception, as a fault of a DDS library would.
[[noreturn]] void drive(const std::string& name) {
  runtime::install_stop_signals();
  std::signal(SIGUSR1, [](int) { throw_requested = 1; });
  const auto rig = emulated_rig();
  try {
    EmulatedBoard board{rig, std::make_unique<LinkedRig>(name)};
    for (std::int64_t tick = 0; !runtime::stop_requested(); ++tick) {
      board.advance_to(tick * kTick_ns);
      (void)board.read();
      if (throw_requested != 0) std::thread{[] { throw std::runtime_error{"nobody catches this"}; }}.join();
      board.write({{4, 4, 0}, {true, true, true}, tick % 2 == 0});
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    ::_exit(1);
  }
  ::_exit(0);
}

class Death : public testing::TestWithParam<int> {
 protected:
  Death() : name_{unique_name("death")}, server_{rig_, name_, true, GetParam()} {
    child_ = ::fork();
    if (child_ == 0) drive(name_);
    while (server_.rig().crane().truth().trolley_mps < 0.7) server_.serve_advance();
  }
  ~Death() override { ::kill(child_, SIGKILL); }

  [[nodiscard]] bool braked() {
    return server_.rig().crane().read().brake_closed == std::array<bool, kDrives>{true, true, true};
  }
  void pass(std::int64_t duration_ns) {
    server_.run_to(server_.rig().now_ns() + duration_ns, runtime::monotonic_ns());
  }
  /// Serves the driver until its process has ended. @return its wait status
  int serve_to_the_end() {
    int status = 0;
    while (::waitpid(child_, &status, WNOHANG) == 0) server_.serve_advance();
    return status;
  }

  configuration::Rig rig_ = emulated_rig();
  std::string name_;
  RigServer server_;
  pid_t child_;
};

TEST_P(Death, BySigtermLeavesZeroVoltsAndClosedBrakes) {
  ASSERT_FALSE(braked());
  ::kill(child_, SIGTERM);
  EXPECT_EQ(serve_to_the_end(), 0);
  pass(1);  // the rig reads the lines
  EXPECT_EQ(server_.rig().drive_v(), kNothing);
  pass(20'000'000);
  EXPECT_TRUE(braked());
}

TEST_P(Death, BySigkillLeavesTheVoltsAndTheRelayClosesTheBrakesWithin50Ms) {
  ASSERT_FALSE(braked());
  ::kill(child_, SIGKILL);
  ::waitpid(child_, nullptr, 0);
  pass(1);  // the last lines with the last toggle
  EXPECT_NE(server_.rig().drive_v(), kNothing) << "a card holds its voltages";
  pass(49'999'999);
  EXPECT_TRUE(server_.rig().crane().read().watchdog_dropped);
  EXPECT_TRUE(braked());
}

TEST_P(Death, ByAnUncaughtExceptionIsSigabrtAndTheRelayClosesTheBrakesWithin50Ms) {
  ASSERT_FALSE(braked());
  ::kill(child_, SIGUSR1);
  const int status = serve_to_the_end();
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGABRT);
  pass(50'000'000);
  EXPECT_TRUE(server_.rig().crane().read().watchdog_dropped);
  EXPECT_TRUE(braked());
}

TEST_P(Death, BySigkillLeavesACardThatTheNextBridgeTakesOverSafely) {
  ::kill(child_, SIGKILL);
  ::waitpid(child_, nullptr, 0);
  const EmulatedBoard next{rig_, std::make_unique<LinkedRig>(name_)};
  pass(1);
  EXPECT_EQ(server_.rig().drive_v(), kNothing);
  pass(20'000'000);
  EXPECT_TRUE(braked());
}

TEST_P(Death, OfTheFirstBridgeOnlyPermitsASecondBridge) {
  ::kill(child_, SIGSTOP);
  try {
    const LinkedRig second{name_};
    FAIL() << "accepted";
  } catch (const BoardError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("another hardware bridge uses this board"));
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Death, testing::Values(1, 2),
                         [](const auto& test) { return "servo_to_go_model_" + std::to_string(test.param); });

constexpr std::int64_t kToggle_ns = 5'000'000;  // half a period of the watchdog output

/// The card stamps every change of its lines with CLOCK_MONOTONIC. Therefore the bridge must write in real
/// time.
void wait_until(std::int64_t time_ns) {
  const timespec time{.tv_sec = time_ns / 1'000'000'000, .tv_nsec = time_ns % 1'000'000'000};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

TEST(RigServer, MissesNoToggleDuringADelayOfItsStep) {
  auto rig = emulated_rig();
  rig.wiring.relay_timeout_s = 1;  // the computer may be busy
  const auto name = unique_name("late");
  RigServer server{rig, name, false, 1};
  LinkedRig card{name};
  const auto toggling =
      static_cast<std::uint16_t>(1U << static_cast<unsigned>(rig.wiring.watchdog_output - 16));
  constexpr std::int64_t kLongEnough_ns = 60'000'000;  // for the relay to close
  card.set_outputs(toggling);  // a late first toggle must not shorten the time of toggling
  const auto begin_ns = runtime::monotonic_ns();
  for (std::int64_t at_ns = 0; at_ns < kLongEnough_ns; at_ns += 2 * kToggle_ns) {
    wait_until(begin_ns + at_ns + kToggle_ns);
    card.set_outputs(toggling);
    wait_until(begin_ns + at_ns + 2 * kToggle_ns);
    card.set_outputs(0);
  }
  server.run_to(runtime::monotonic_ns() - begin_ns, runtime::monotonic_ns());
  EXPECT_FALSE(server.rig().crane().read().watchdog_dropped);
}

/// A voltage that ended before the next step of the rig must nevertheless have moved the crane.
TEST(RigServer, AppliesTheVoltsOfAPauseAtTheirTimes) {
  auto rig = emulated_rig();
  rig.wiring.relay_timeout_s = 1;  // the computer may be busy
  const auto name = unique_name("volts");
  RigServer server{rig, name, false, 1};
  EmulatedBoard card{rig, std::make_unique<LinkedRig>(name)};
  const auto begin_ns = runtime::monotonic_ns();
  std::int64_t at_ns = 0;
  bool level = false;
  const auto write_until = [&](std::int64_t time_ns, double volts_v) {
    for (; at_ns < time_ns; at_ns += kToggle_ns) {
      wait_until(begin_ns + at_ns + kToggle_ns);
      card.write({{volts_v, 0, 0}, {true, true, true}, level = !level});
    }
  };
  write_until(100'000'000, 0);  // for the relay to close and the brakes to open
  write_until(130'000'000, 8);
  write_until(140'000'000, 0);
  const auto end_ns = runtime::monotonic_ns();
  server.run_to(end_ns - begin_ns, end_ns);
  EXPECT_GT(server.rig().crane().truth().trolley_mps, 0.02);
}

TEST(RigServer, HasReachedThePresentWhenTheCardLatchesItsCounters) {
  const auto rig = emulated_rig();
  const auto name = unique_name("latch");
  RigServer server{rig, name, false, 1};
  LinkedRig card{name};
  constexpr std::int64_t kMinute_ns = 60'000'000'000;  // the next step of the rig without a request
  const auto begin_ns = runtime::monotonic_ns();
  std::thread serving{[&] { server.serve_realtime(begin_ns, begin_ns + kMinute_ns); }};
  const auto latched_ns = runtime::monotonic_ns();
  card.advance_to(0);
  serving.join();
  EXPECT_GE(server.lines().lines_at_ns, latched_ns);
  EXPECT_LT(server.lines().lines_at_ns, begin_ns + kMinute_ns);
}

TEST(RigServer, RefusesASecondRigOfTheSameName) {
  const auto rig = emulated_rig();
  const auto name = unique_name("twice");
  const RigServer first{rig, name, true, 1};
  EXPECT_THROW((RigServer{rig, name, true, 1}), BoardError);
}

TEST(RigServer, TakesOverTheSharedMemoryOfADeadRig) {
  const auto rig = emulated_rig();
  const auto name = unique_name("left");
  const auto child = ::fork();
  if (child == 0) {
    new RigServer{rig, name, true, 1};  // never destroyed, like a process that is killed
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_NO_THROW((RigServer{rig, name, true, 1}));
}

}  // namespace
}  // namespace crane::bridge::test
