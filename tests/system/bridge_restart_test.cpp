/// The bridge ends and restarts while the rest of the stack runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "crane/boards/linked_rig.hpp"
#include "running_stack.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 95;
constexpr const char* kRig = "emulated_servo_to_go";

class BridgeRestart : public testing::Test {
 protected:
  [[nodiscard]] const Observer& observer() const { return running_.observer(); }
  [[nodiscard]] bool supervisor_is(crane_SupervisorState state) const {
    return !observer().statuses().empty() && observer().statuses().back().state == state;
  }
  [[nodiscard]] bool locked_by_restart() const {
    return supervisor_is(crane_STATE_LOCKED) &&
           observer().statuses().back().cause == crane_CAUSE_BRIDGE_RESTARTED;
  }

  /// Kills the bridge of an armed crane, waits until the rig has closed the brakes, and starts another
  /// bridge.
  void exchange_bridge() {
    const auto kill_ns = runtime::monotonic_ns();
    running_.send("hardware_bridge", SIGKILL);
    ASSERT_TRUE(running_.until([&] { return monitor_.lines().brakes_closed_ns > kill_ns; }, 2s));
    ASSERT_TRUE(running_.until([this] { return supervisor_is(crane_STATE_STOP_C1); }, 2s));
    running_.forget();
    running_.start_again("hardware_bridge");
    ASSERT_TRUE(running_.until([this] { return locked_by_restart(); }, 10s))
        << experiments::in_words(observer().statuses().back());
    for (const auto& command : observer().commands())
      for (std::size_t i = 0; i < 3; ++i)
        ASSERT_TRUE(command.drive_v[i] == 0 && !command.brake_release[i]) << "moved by itself";
  }
  /// Reason for the refusal of a reset; empty when accepted.
  std::string refusal(bool confirmed) {
    try {
      running_.session().request({.kind = crane_REQUEST_RESET, .selected = {confirmed, confirmed, confirmed}},
                                 "reset");
    } catch (const experiments::SessionError& error) {
      return error.what();
    }
    return "";
  }
  /// True when the load has not swung for half a period.
  bool until_load_is_still() {
    constexpr std::size_t kStates = 110;
    constexpr double kStill_rad = 0.0015;
    running_.forget();
    return running_.until(
        [this] {
          const auto& states = observer().states();
          return states.size() >= kStates &&
                 std::all_of(states.end() - kStates, states.end(), [](const msg::State& state) {
                   return std::abs(state.swing_radial_rad) < kStill_rad &&
                          std::abs(state.swing_tangential_rad) < kStill_rad;
                 });
        },
        20s);
  }

  RunningStack running_{kDomain, kRig, stack::Plant::hardware};
  bridge::RigMonitor monitor_{bridge::shared_lines_name(running_.bus_options().crane, kDomain)};
};

TEST_F(BridgeRestart, OfACraneAtRestNeedsResetAndArmAndThenItMoves) {
  running_.session().arm();
  exchange_bridge();
  running_.session().arm();
  running_.session().move_to({true, false, false}, {0.6, 0, 0}, 10s);
  // the band of the planner of 1 cm, plus the motion that the load causes afterwards
  constexpr double kArrived_m = 0.02;
  EXPECT_NEAR(running_.session().state()->trolley_position_m, 0.6, kArrived_m);
}

TEST_F(BridgeRestart, OfACraneAtAnotherPositionNeedsAConfirmation) {
  running_.session().arm();
  running_.session().move_to({true, false, false}, {0.6, 0, 0}, 10s);
  ASSERT_TRUE(until_load_is_still());
  exchange_bridge();
  EXPECT_THAT(refusal(false), HasSubstr("crane reset --confirm-positions"));
  running_.session().request_with_patience({.kind = crane_REQUEST_RESET, .selected = {true, true, true}},
                                           "reset");
  running_.session().request_with_patience({.kind = crane_REQUEST_ARM}, "arm");
  EXPECT_NO_THROW(running_.session().wait_for(crane_STATE_HOLD, 5s));
}

TEST_F(BridgeRestart, BelowASwingingLoadIsRefused) {
  running_.session().arm();
  running_.session().request(
      {.kind = crane_REQUEST_MOVE, .selected = {true, true, false}, .target = {1.0, 1.5, 0}}, "move");
  ASSERT_TRUE(
      running_.until([this] { return std::abs(observer().states().back().trolley_speed_mps) > 0.3; }, 5s));
  exchange_bridge();
  ASSERT_TRUE(
      running_.until([this] { return std::abs(observer().states().back().swing_radial_rad) > 0.02; }, 2s));
  EXPECT_THAT(refusal(true), HasSubstr("let the load hang at rest"));
  EXPECT_TRUE(locked_by_restart());
}

}  // namespace
}  // namespace crane::system_test
