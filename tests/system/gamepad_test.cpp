/// A gamepad drives a running stack. The button of the gamepad is released, or the gamepad is unplugged,
/// during motion and during a return.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <future>

#include "cli/gamepad.hpp"
#include "cli/jog_loop.hpp"
#include "cli/tool_bus.hpp"
#include "running_stack.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 56;
constexpr int kAway = -32768;
constexpr std::array kTrolley{true, false, false};

/// Replaces the device. The test sets its state while the operator's loop reads its events.
struct HandAtTheGamepad {
  std::atomic<bool> held = false, unplugged = false, returns = false, blocked = false;
  std::atomic<int> stick = 0;

  int read(std::vector<cli::GamepadEvent>& events) {
    blocked.wait(true);
    if (unplugged) return ENODEV;
    if (held != was_held_) events.push_back({EV_KEY, BTN_TL, held ? 1 : 0});
    was_held_ = held;
    events.push_back({EV_ABS, ABS_Y, stick});
    if (returns.exchange(false)) events.push_back({EV_KEY, BTN_SOUTH, 1});
    return 0;
  }

 private:
  bool was_held_ = false;
};

class JogGamepad : public testing::Test {
 protected:
  JogGamepad() {
    stack_.session().arm();
    run_ = std::async(std::launch::async, [this] { return operate(); });
    hand_.held = true;
    stack_.listen(1s);
    hand_.stick = kAway;
  }
  ~JogGamepad() override {
    block(false);
    hand_.unplugged = true;  // ends the operator's loop
    if (run_.valid()) run_.wait();
  }

  /// Suspends or continues the operator's loop.
  void block(bool wanted) {
    hand_.blocked = wanted;
    hand_.blocked.notify_all();
  }
  /// Runs the operator's loop. @return its exit code, or the message of its exception
  std::string operate() {
    auto options = stack_.bus_options();
    options.vendor = "fastdds";
    auto bus = cli::open_bus(options, crane_SOURCE_OPERATOR);
    cli::Gamepad gamepad{"pad", [this](auto& events) { return hand_.read(events); },
                         cli::GamepadLaw{cli::StickRanges{}, kTrolley}};
    cli::JogLoop loop{bus, gamepad, {.selected = kTrolley}};
    try {
      return "exit code " + std::to_string(loop.run());
    } catch (const std::exception& error) {
      return error.what();
    }
  }
  /// @param direction  1: outwards, -1: inwards
  [[nodiscard]] bool until_the_trolley_drives(double direction = 1) {
    stack_.forget();
    return stack_.until(
        [&] {
          const auto& states = stack_.observer().states();
          return !states.empty() && direction * states.back().trolley_speed_mps > 0.1;
        },
        15s);
  }
  [[nodiscard]] bool until(crane_SupervisorState wanted) {
    stack_.forget();
    return stack_.until(
        [&] {
          const auto& statuses = stack_.observer().statuses();
          return !statuses.empty() && statuses.back().state == wanted;
        },
        15s);
  }
  [[nodiscard]] bool until_hold() { return until(crane_STATE_HOLD); }
  /// Drives, releases the stick, and requests the return. @return true when the trolley drives back
  [[nodiscard]] bool begin_return() {
    if (!until_the_trolley_drives()) return false;
    hand_.stick = 0;
    stack_.listen(500ms);  // the trolley has not stopped yet
    hand_.returns = true;
    return until_the_trolley_drives(-1);
  }
  [[nodiscard]] double speed_mps() const {
    return std::abs(stack_.observer().states().back().trolley_speed_mps);
  }

  RunningStack stack_{kDomain, "virginia_tech_tower"};
  HandAtTheGamepad hand_;
  std::future<std::string> run_;
};

TEST_F(JogGamepad, ThatVanishesDuringMotionLeavesTheCraneAtRestInHold) {
  ASSERT_TRUE(until_the_trolley_drives());
  hand_.unplugged = true;
  const auto reason = run_.get();
  EXPECT_THAT(reason, HasSubstr("jog: the gamepad pad was unplugged"));
  ASSERT_TRUE(until_hold());
  EXPECT_LT(speed_mps(), 0.02);
  EXPECT_EQ(stack_.observer().statuses().back().cause, crane_CAUSE_NONE);
}

TEST_F(JogGamepad, StopsWhenTheDeadMansButtonIsReleasedAndDoesNotResumeWithADeflectedStick) {
  ASSERT_TRUE(until_the_trolley_drives());
  hand_.held = false;
  ASSERT_TRUE(until_hold());
  stack_.listen(1s);
  hand_.held = true;
  stack_.forget();
  stack_.listen(2s);
  EXPECT_LT(speed_mps(), 0.02);
  EXPECT_EQ(stack_.observer().statuses().back().state, crane_STATE_HOLD);
  hand_.stick = 0;
  stack_.listen(200ms);
  hand_.stick = kAway;
  EXPECT_TRUE(until_the_trolley_drives()) << "the stick was in the centre";
}

TEST_F(JogGamepad, WhoseProgramWasSuspendedActsAgainOnlyAfterARelease) {
  ASSERT_TRUE(until_the_trolley_drives());
  block(true);
  ASSERT_TRUE(until_hold());
  block(false);
  stack_.forget();
  stack_.listen(2s);
  EXPECT_LT(speed_mps(), 0.02);
  EXPECT_EQ(stack_.observer().statuses().back().state, crane_STATE_HOLD);
  hand_.stick = 0;
  stack_.listen(200ms);
  hand_.stick = kAway;
  EXPECT_TRUE(until_the_trolley_drives()) << "the stick was in the centre";
}

TEST_F(JogGamepad, ThatVanishesDuringAReturnStopsAndLocksTheCrane) {
  ASSERT_TRUE(begin_return());
  hand_.unplugged = true;
  EXPECT_THAT(run_.get(), AllOf(HasSubstr("return: the gamepad pad was unplugged"), HasSubstr("crane arm")));
  EXPECT_TRUE(until(crane_STATE_LOCKED));
}

TEST_F(JogGamepad, WhoseButtonIsReleasedDuringAReturnStopsAndLocksTheCrane) {
  ASSERT_TRUE(begin_return());
  hand_.held = false;
  EXPECT_THAT(run_.get(), HasSubstr("return: stopped by the operator"));
  EXPECT_TRUE(until(crane_STATE_LOCKED));
}

}  // namespace
}  // namespace crane::system_test
