// The process of the supervisor in real time with an armed crane: late states, model checks, configurations.
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "crane/runtime/convert.hpp"
#include "supervisor_in_real_time.hpp"

namespace crane::supervisor {
namespace {

/// A crane at rest whose brakes and relay obey the commands, in RUN: the reference moves.
class RunInRealTime : public SupervisorInRealTime {
 protected:
  explicit RunInRealTime(bool model_checks = true) : SupervisorInRealTime{0, model_checks} {
    state_.trolley_position_m = 0.5;
    state_.cable_length_m = 1;
    std::ranges::fill(state_.position_known, true);
    state_.watchdog_dropped = true;
    std::ranges::fill(state_.brake_closed, true);
    ticks(250);
    ask(crane_REQUEST_RESET);
    ticks(110);
    ask(crane_REQUEST_ARM);
    ticks(20);
    ask(crane_REQUEST_MOVE);
    reference_.moving = true;
    reference_.move_number = 1;
    ticks(30);
    EXPECT_EQ(supervisor_state(), crane_STATE_RUN);
  }
  void ask(crane_RequestKind kind) { ask(kind, state_.header); }
  /// @param named  header of the sample that the request names
  void ask(crane_RequestKind kind, const msg::Header& named) {
    msg::Request request{};
    request.header = runtime::answer_to(named);
    request.id = ++last_id_;
    request.kind = kind;
    request.selected[0] = true;
    request.target[0] = 0.9;
    EXPECT_TRUE(requests_.publish(request));
  }
  void ticks(int count) {
    for (int k = 0; k < count; ++k) {
      ++tick_;
      while (const auto command = commands_.take()) {
        for (std::size_t i = 0; i < 3; ++i) state_.brake_closed[i] = !command->brake_release[i];
        state_.watchdog_dropped = !command->watchdog_permission;
      }
      state_comes(tick_);
      wake_at(now_ms());
      demand_comes(tick_);
      wake_at(now_ms() + 0.5);
    }
  }
  [[nodiscard]] double now_ms() const { return 10.0 * static_cast<double>(tick_); }
  [[nodiscard]] int events_with(std::string_view code) {
    int count = 0;
    while (const auto event = events_.take()) count += event->code == code ? 1 : 0;
    return count;
  }

  std::uint64_t tick_ = 10, last_id_ = 0;
  bus::Bus operator_{runtime::memory_options(network_, "operator", crane_SOURCE_OPERATOR)};
  bus::Publisher<msg::Request> requests_ = operator_.publisher(topics::request);
  bus::Subscriber<msg::Command> commands_ = operator_.subscriber(topics::command);
  bus::Subscriber<msg::Event> events_ = operator_.subscriber(topics::event);
};

class RunWithoutModelChecks : public RunInRealTime {
 protected:
  RunWithoutModelChecks() : RunInRealTime{false} {}
};

TEST_F(RunInRealTime, ReportsNothingAboutItsModelChecks) { EXPECT_EQ(events_with("model_checks_off"), 0); }

TEST_F(RunWithoutModelChecks, IsReportedOncePerArming) { EXPECT_EQ(events_with("model_checks_off"), 1); }

TEST_F(RunInRealTime, ALateStateDoesNotEndTheMove) {
  const int before = steps();
  sleep_until(now_ms() + 29);  // one step without a state, 15 ms after the last one
  EXPECT_EQ(steps(), before + 1);
  EXPECT_EQ(supervisor_state(), crane_STATE_RUN);
  ticks(5);
  EXPECT_EQ(supervisor_state(), crane_STATE_RUN);
  reference_.moving = false;
  ticks(1);
  EXPECT_EQ(supervisor_state(), crane_STATE_HOLD);
}

/// The network delays the requests of one host by more than a second. Another host stops the crane meanwhile.
TEST_F(RunInRealTime, ARequestThatNamesATickBeforeTheStopIsRefused) {
  const auto before = state_.header;
  ask(crane_REQUEST_ESTOP);
  reference_.moving = false;
  ticks(150);
  ASSERT_EQ(supervisor_state(), crane_STATE_ESTOP);
  ask(crane_REQUEST_RESET, before);
  ticks(5);
  EXPECT_EQ(supervisor_state(), crane_STATE_ESTOP);
  ask(crane_REQUEST_RESET);
  ticks(5);
  EXPECT_EQ(supervisor_state(), crane_STATE_READY);
}

TEST_F(RunInRealTime, AStopHasPrecedenceOverTheOtherRequestsOfItsTick) {
  ask(crane_REQUEST_ESTOP);
  reference_.moving = false;
  ticks(150);
  ask(crane_REQUEST_RESET);
  ask(crane_REQUEST_ESTOP);
  ticks(5);
  EXPECT_EQ(supervisor_state(), crane_STATE_ESTOP);
  ask(crane_REQUEST_RESET);
  ticks(5);
  ASSERT_EQ(supervisor_state(), crane_STATE_READY);
  ask(crane_REQUEST_ARM);
  ask(crane_REQUEST_STOP);
  ticks(5);
  EXPECT_EQ(supervisor_state(), crane_STATE_LOCKED);
}

/// One input states another configuration (1), or states that one of its own inputs has another one (0).
class AnotherConfiguration : public RunInRealTime, public testing::WithParamInterface<std::uint32_t> {
 protected:
  void expect_power_removed() {
    ticks(1);
    EXPECT_EQ(supervisor_state(), crane_STATE_STOP_C0);
    EXPECT_EQ(cause(), crane_CAUSE_CONFIGURATION_DIFFERS);
  }
};

TEST_P(AnotherConfiguration, OfTheBridgeRemovesPowerInTheSameTick) {
  state_.configuration = GetParam();
  expect_power_removed();
}

TEST_P(AnotherConfiguration, OfTheDemandRemovesPowerInTheSameTick) {
  demand_.configuration = GetParam();
  expect_power_removed();
}

TEST_P(AnotherConfiguration, OfTheReferenceRemovesPowerInTheSameTick) {
  reference_.configuration = GetParam();
  expect_power_removed();
}

TEST_P(AnotherConfiguration, PreventsAResetUntilTheProcessHasThatOfTheSupervisor) {
  const auto own = std::exchange(reference_.configuration, GetParam());
  reference_.moving = false;
  ticks(200);
  ask(crane_REQUEST_RESET);
  ticks(1);
  EXPECT_EQ(supervisor_state(), crane_STATE_LOCKED);
  reference_.configuration = own;
  ticks(200);
  ask(crane_REQUEST_RESET);
  ticks(1);
  EXPECT_EQ(supervisor_state(), crane_STATE_READY);
}

INSTANTIATE_TEST_SUITE_P(AnotherOneOrADifferenceUpstream, AnotherConfiguration, testing::Values(1, 0));

}  // namespace
}  // namespace crane::supervisor
