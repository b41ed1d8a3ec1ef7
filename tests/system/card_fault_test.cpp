/// Faults of the card and of its wiring while the crane moves, through the process of the bridge: the
/// emulated registers do not obey. The stack gives 0 V and closes the brakes as far as the fault permits, and
/// names the fault. docs/safety.md states what only the wiring of the rig can do.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>

#include "crane/boards/linked_rig.hpp"
#include "crane/bridge/converter.hpp"
#include "running_stack.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 82;
constexpr const char* kRig = "emulated_servo_to_go";
/// From the onset to the closed brakes: 100 ms until the fault is distinguished from the tolerances, two
/// ticks, and 45 ms for relay and brake.
constexpr auto kClosed = 170ms;

class CardFault : public testing::Test {
 protected:
  [[nodiscard]] const msg::State& state() const { return running_.observer().states().back(); }
  [[nodiscard]] const msg::SupervisorStatus& status() const { return running_.observer().statuses().back(); }
  [[nodiscard]] bool brake_contacts_closed() const {
    constexpr unsigned kTrolleyBrake = 1U << 7U, kSlewBrake = 1U << 8U;  // [wiring] of the rig; low: closed
    return (monitor_.lines().inputs & (kTrolleyBrake | kSlewBrake)) == 0;
  }
  [[nodiscard]] std::array<std::int32_t, 2> pulses() const {
    return {monitor_.lines().pulses[0], monitor_.lines().pulses[1]};
  }
  [[nodiscard]] bool outputs_are_zero() const {
    return std::ranges::all_of(monitor_.lines().codes,
                               [](const auto& code) { return code == bridge::kConverterZero; });
  }
  void move_fast(bool trolley = true, bool slew = true) {
    running_.session().arm();
    running_.session().request(
        {.kind = crane_REQUEST_MOVE, .selected = {trolley, slew, false}, .target = {1.0, 1.5, 0}}, "move");
    ASSERT_TRUE(running_.until(
        [&] {
          const auto& states = running_.observer().states();
          return !states.empty() && (!trolley || states.back().trolley_speed_mps > 0.2) &&
                 (!slew || states.back().slew_speed_radps > 0.3);
        },
        5s));
  }
  /// @return the time until the brake contacts have closed
  std::chrono::milliseconds closing_time_after(std::uint32_t faults) {
    running_.forget();
    const auto begin = std::chrono::steady_clock::now();
    monitor_.inject(faults);
    while (!brake_contacts_closed() && std::chrono::steady_clock::now() < begin + 2s) running_.listen(2ms);
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begin);
  }
  void expect_rest() {
    const auto before = pulses();
    running_.listen(500ms);
    EXPECT_EQ(pulses(), before);
  }
  void stop() {
    running_.session().request({.kind = crane_REQUEST_ESTOP}, "estop");
    running_.listen(400ms);
  }
  [[nodiscard]] bool refused_to_reset() {
    try {
      running_.session().request({.kind = crane_REQUEST_RESET}, "reset");
    } catch (const experiments::SessionError&) {
      return true;
    }
    return false;
  }
  void print(const char* fault, std::chrono::milliseconds closed) const {
    std::cout << fault << ": brakes closed after " << closed.count() << " ms, "
              << experiments::in_words(status()) << ", latch " << state().latch_reason << '\n';
  }

  RunningStack running_{kDomain, kRig, stack::Plant::hardware};
  bridge::RigMonitor monitor_{bridge::shared_lines_name(running_.bus_options().crane, kDomain)};
};

/// 0 V is impossible: the converters do not obey. A closed brake holds an axis against its drive when the
/// voltage is below the full one. Arming again moves the axis by at most 0.1 m.
TEST_F(CardFault, AStuckConverterClosesTheBrakesAndArmingStopsAtOnce) {
  ASSERT_NO_FATAL_FAILURE(move_fast(true, false));
  const auto closed = closing_time_after(bridge::kStuckConverters);
  running_.listen(500ms);
  print("stuck converter, trolley", closed);
  EXPECT_LT(closed, 1000ms);
  EXPECT_FALSE(outputs_are_zero());
  EXPECT_TRUE(brake_contacts_closed());
  EXPECT_EQ(status().state, crane_STATE_LOCKED);
  expect_rest();
  const double before_m = state().trolley_position_m;
  try {
    running_.session().arm();
  } catch (const experiments::SessionError& error) {
    std::cout << error.what() << '\n';  // the crane may stop before HOLD
  }
  running_.listen(1s);
  print("stuck converter, armed again", 0ms);
  EXPECT_TRUE(brake_contacts_closed());
  std::cout << "moved by " << state().trolley_position_m - before_m << " m\n";
  EXPECT_EQ(status().state, crane_STATE_LOCKED);
  EXPECT_NEAR(state().trolley_position_m, before_m, 0.1);
  expect_rest();
}

/// The brake of the jib gives the torque of its motor at full voltage. Near this voltage the closed brake
/// stops the jib slowly or not at all: the fault is then final, and only a relay that disables the drive can
/// act.
TEST_F(CardFault, AStuckConverterOfTheJibEndsAtRestOrInFault) {
  ASSERT_NO_FATAL_FAILURE(move_fast());
  const auto closed = closing_time_after(bridge::kStuckConverters);
  const auto ended = [this] {
    return status().state == crane_STATE_FAULT || status().state == crane_STATE_LOCKED;
  };
  EXPECT_TRUE(running_.until(ended, 5s)) << experiments::in_words(status());
  print("stuck converters, both axes", closed);
  EXPECT_LT(closed, kClosed);
  EXPECT_TRUE(brake_contacts_closed());
  if (status().state == crane_STATE_FAULT) {
    EXPECT_EQ(status().cause, crane_CAUSE_BRAKE_DID_NOT_CLOSE);
    EXPECT_TRUE(refused_to_reset());
  } else {
    expect_rest();
  }
}

TEST_F(CardFault, StuckLatchesGiveZeroVoltsAndCloseTheBrakes) {
  ASSERT_NO_FATAL_FAILURE(move_fast());
  const auto closed = closing_time_after(bridge::kStuckLatches);
  running_.listen(200ms);
  print("stuck latches", closed);
  EXPECT_LT(closed, kClosed);
  EXPECT_TRUE(outputs_are_zero());
  expect_rest();
}

/// The stop itself is not disturbed: the brake outputs remove the supply. The welded relay is detected at the
/// stop, and the crane cannot be armed again.
TEST_F(CardFault, AWeldedRelayIsDetectedAtTheNextStop) {
  ASSERT_NO_FATAL_FAILURE(move_fast());
  monitor_.inject(bridge::kWeldedRelay);
  running_.listen(200ms);
  EXPECT_EQ(status().state, crane_STATE_RUN) << "a closed relay is the normal state of a moving crane";
  stop();
  print("welded relay", 0ms);
  EXPECT_EQ(status().state, crane_STATE_FAULT);
  EXPECT_EQ(status().cause, crane_CAUSE_RELAY_DID_NOT_OPEN);
  EXPECT_TRUE(outputs_are_zero());
  EXPECT_TRUE(brake_contacts_closed());
  EXPECT_TRUE(refused_to_reset());
  expect_rest();
}

/// The relay removes the supply of the brakes.
TEST_F(CardFault, StuckBrakeOutputsAreClosedByTheRelay) {
  ASSERT_NO_FATAL_FAILURE(move_fast());
  monitor_.inject(bridge::kStuckBrakeOutputs);
  running_.listen(100ms);
  stop();
  print("stuck brake outputs", 0ms);
  EXPECT_TRUE(outputs_are_zero());
  EXPECT_TRUE(brake_contacts_closed());
  expect_rest();
}

/// No output of the card can close the brakes. The drives get 0 V, and the supervisor names the fault; only
/// an emergency stop that cuts the supply by wire closes the brakes.
TEST_F(CardFault, ABrakeSupplyThatNeverDropsIsAFaultWithZeroVolts) {
  ASSERT_NO_FATAL_FAILURE(move_fast());
  monitor_.inject(bridge::kWeldedRelay | bridge::kStuckBrakeOutputs);
  running_.listen(100ms);
  stop();
  print("brake supply stays", 0ms);
  EXPECT_EQ(status().state, crane_STATE_FAULT);
  EXPECT_EQ(status().cause, crane_CAUSE_BRAKE_DID_NOT_CLOSE);
  EXPECT_TRUE(outputs_are_zero());
  EXPECT_FALSE(brake_contacts_closed());
  EXPECT_TRUE(refused_to_reset());
}

}  // namespace
}  // namespace crane::system_test
