// The process of the supervisor in real time, with a clock that the test sets: which ticks count as missing
// when samples are late, or when the process is scheduled late. Times in milliseconds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "crane/runtime/in_process.hpp"
#include "crane/supervisor/component.hpp"

namespace crane::supervisor {
namespace {

class SupervisorInRealTime : public testing::Test {
 protected:
  static constexpr std::int64_t kBegin_ns = 1'000'000'000;

  /// Ten complete ticks in time; the step of tick 10 is at 100.5 ms.
  /// @param bridge_ahead_ns  offset of the clock of the bridge's host relative to that of the supervisor
  /// @param model_checks     of the rig file
  explicit SupervisorInRealTime(std::int64_t bridge_ahead_ns = 0, bool model_checks = true)
      : bridge_ahead_ns_{bridge_ahead_ns}, rig_{tower(model_checks)} {
    state_.configuration = demand_.configuration = reference_.configuration =
        configuration::digest(rig_, rig_.controller);
    for (std::uint64_t tick = 1; tick <= 10; ++tick) {
      const double at_ms = 10.0 * static_cast<double>(tick);
      state_comes(tick);
      wake_at(at_ms);
      demand_comes(tick);
      wake_at(at_ms + 0.5);
    }
    EXPECT_EQ(missing(), 0U);
  }

  /// @param wrong_time_ns  sample time of the state; 0: the correct one
  void state_comes(std::uint64_t tick, std::int64_t wrong_time_ns = 0) {
    state_.header = header(tick);
    if (wrong_time_ns != 0) state_.header.sample_time_ns = wrong_time_ns;
    EXPECT_TRUE(states_.publish(state_));
  }
  void demand_comes(std::uint64_t tick) {
    demand_.header = header(tick);
    EXPECT_TRUE(demands_.publish(demand_));
    reference_.header = header(tick);
    EXPECT_TRUE(references_.publish(reference_));
  }
  /// The process is scheduled now.
  void wake_at(double time_ms) {
    const auto now_ns = kBegin_ns + std::llround(time_ms * 1e6);
    while (supervisor_->poll(now_ns)) continue;
    while (const auto status = statuses_.take()) {
      status_ = *status;
      ++steps_;
    }
  }
  /// The process sleeps until its wake-up time, repeatedly until `time_ms`.
  void sleep_until(double time_ms) {
    for (double next_ms = due_ms(); next_ms <= time_ms; next_ms = due_ms()) wake_at(next_ms);
  }
  [[nodiscard]] double due_ms() const {
    return static_cast<double>(supervisor_->wake_at_ns() - kBegin_ns) * 1e-6;
  }
  [[nodiscard]] std::uint64_t missing() const { return status_.missing_demand_count; }
  [[nodiscard]] bool demand_is_stale() const { return status_.demand_stale; }
  [[nodiscard]] bool state_is_stale() const { return status_.state_stale; }
  [[nodiscard]] int steps() const { return steps_; }
  [[nodiscard]] crane_SupervisorState supervisor_state() const { return status_.state; }
  [[nodiscard]] crane_Cause cause() const { return status_.cause; }

  msg::State state_{};
  msg::Demand demand_{};
  msg::Reference reference_{};
  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();

 private:
  [[nodiscard]] static configuration::Rig tower(bool model_checks) {
    auto rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
    rig.limits.model_checks = model_checks;
    return rig;
  }
  [[nodiscard]] msg::Header header(std::uint64_t tick) const {
    msg::Header header{};
    header.tick = tick;
    header.sample_time_ns = kBegin_ns + bridge_ahead_ns_ + static_cast<std::int64_t>(tick) * 10'000'000;
    header.epoch = 1;
    return header;
  }
  std::int64_t bridge_ahead_ns_;
  bus::Bus plant_{runtime::memory_options(network_, "plant", crane_SOURCE_PLANT)};
  bus::Bus friction_{runtime::memory_options(network_, "friction_compensation", crane_SOURCE_FRICTION)};
  bus::Bus planner_{runtime::memory_options(network_, "planner", crane_SOURCE_PLANNER)};
  bus::Publisher<msg::State> states_ = plant_.publisher(topics::state);
  bus::Publisher<msg::Demand> demands_ = friction_.publisher(topics::demand);
  bus::Publisher<msg::Reference> references_ = planner_.publisher(topics::reference);
  bus::Subscriber<msg::SupervisorStatus> statuses_ = planner_.subscriber(topics::supervisor);
  configuration::Rig rig_;
  bus::Bus bus_{runtime::memory_options(network_, "crane_supervisor", crane_SOURCE_SUPERVISOR)};
  runtime::HostedComponent hosted_{bus_, supervisor_spec(), rig_, runtime::chosen_controller("", rig_),
                                   runtime::Clock::realtime};
  runtime::Component* supervisor_ = &hosted_.component();
  msg::SupervisorStatus status_{};
  int steps_ = 0;
};

using RealTime = SupervisorInRealTime;

class RealTimeOnTwoHosts : public SupervisorInRealTime, public testing::WithParamInterface<std::int64_t> {
 protected:
  RealTimeOnTwoHosts() : SupervisorInRealTime{GetParam()} {}
};

TEST_P(RealTimeOnTwoHosts, SilenceIsMeasuredWithTheClockOfTheSupervisor) {
  state_comes(11);
  wake_at(110);
  demand_comes(11);
  wake_at(110.5);
  EXPECT_FALSE(state_is_stale());
  EXPECT_EQ(steps(), 11);
  sleep_until(139.9);
  EXPECT_EQ(steps(), 12);
  EXPECT_FALSE(state_is_stale());
  sleep_until(155.1);  // 125, 140 and 155 ms
  EXPECT_EQ(steps(), 14);
  EXPECT_TRUE(state_is_stale());
}

INSTANTIATE_TEST_SUITE_P(ClocksAnHourApart, RealTimeOnTwoHosts,
                         testing::Values(0, 3'600'000'000'000, -3'600'000'000'000));

TEST_F(RealTime, CountsATickWithAMissingDemandOnce) {
  state_comes(11);
  wake_at(110);
  sleep_until(119);
  EXPECT_EQ(missing(), 1U);
  EXPECT_EQ(steps(), 11);
}

TEST_F(RealTime, WaitsForTheDemandOfALateState) {
  state_comes(11);
  wake_at(114.5);
  // 115 ms, one and a half periods after state 10: the state has arrived, its demand is due
  sleep_until(118);
  EXPECT_EQ(steps(), 10);
  demand_comes(11);
  wake_at(118);
  EXPECT_EQ(missing(), 0U);
}

TEST_F(RealTime, APauseOfTheComputerIsNotThreeMissingTicks) {
  wake_at(127);  // 12 ms late: state 11 has arrived, but has not been delivered
  EXPECT_EQ(steps(), 10);
  state_comes(11);
  wake_at(127.1);
  state_comes(12);
  wake_at(141);  // a second pause of 14 ms
  sleep_until(142);
  EXPECT_EQ(missing(), 0U);
  demand_comes(12);
  wake_at(142.1);
  EXPECT_EQ(missing(), 0U);
  EXPECT_FALSE(demand_is_stale());
}

TEST_F(RealTime, ALateStepIsNotFollowedByASecondStepAtOnce) {
  state_comes(11);
  wake_at(127);
  demand_comes(11);
  wake_at(130);  // state 11 is 20 ms old, state 12 may be under way
  EXPECT_EQ(steps(), 11);
  sleep_until(134.9);
  EXPECT_EQ(steps(), 11);
  sleep_until(135.1);  // no state 12, 13: silence
  EXPECT_EQ(steps(), 12);
}

TEST_F(RealTime, SilenceIsStateStaleAtTheThirdStepWithoutState) {
  sleep_until(129.9);
  EXPECT_EQ(steps(), 11);
  EXPECT_FALSE(state_is_stale());
  sleep_until(145.1);  // 115, 130 and 145 ms
  EXPECT_EQ(steps(), 13);
  EXPECT_TRUE(state_is_stale());
}

TEST_F(RealTime, ItsOwnPausesDelayAStepByAtMostHalfAPeriod) {
  for (double at_ms = 120; at_ms < 170; at_ms += 5.01) wake_at(at_ms);
  EXPECT_TRUE(state_is_stale());
}

TEST_F(RealTime, AStateWithAWrongSampleTimeIsMissing) {
  for (std::uint64_t tick = 11; tick <= 14; ++tick) {
    const double at_ms = 10.0 * static_cast<double>(tick);
    state_comes(tick, tick < 14 ? std::numeric_limits<std::int64_t>::max() : 0);
    demand_comes(tick);
    wake_at(at_ms + 0.5);
    EXPECT_EQ(steps(), static_cast<int>(tick));
    EXPECT_EQ(state_is_stale(), tick == 13) << "tick " << tick;
  }
}

TEST_F(RealTime, FrequentStatesDoNotDelayTheStepForEver) {
  for (std::uint64_t tick = 11; tick <= 25;
       ++tick) {  // the process is never awake at the end of the wait of a tick
    state_comes(tick);
    wake_at(10.0 * static_cast<double>(tick));
  }
  EXPECT_TRUE(demand_is_stale());
}

/// A crane at rest whose brakes and relay obey the commands, in RUN: the reference moves.
class RunInRealTime : public RealTime {
 protected:
  explicit RunInRealTime(bool model_checks = true) : RealTime{0, model_checks} {
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
  void ask(crane_RequestKind kind) {
    msg::Request request{};
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

TEST_P(AnotherConfiguration, RefusesTheResetUntilTheProcessHasTheSameOne) {
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
