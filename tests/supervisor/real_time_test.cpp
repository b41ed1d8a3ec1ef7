// The process of the supervisor in real time, with a clock that the test sets: which ticks count as missing
// when samples are late, or when the process is scheduled late. Times in milliseconds.
#include <gtest/gtest.h>

#include <cmath>

#include "crane/runtime/in_process.hpp"
#include "crane/supervisor/component.hpp"

namespace crane::supervisor {
namespace {

class SupervisorInRealTime : public testing::Test {
 protected:
  static constexpr std::int64_t kBegin_ns = 1'000'000'000;

  /// Ten complete ticks in time; the step of tick 10 is at 100.5 ms.
  /// @param bridge_ahead_ns  offset of the clock of the bridge's host relative to that of the supervisor
  explicit SupervisorInRealTime(std::int64_t bridge_ahead_ns = 0) : bridge_ahead_ns_{bridge_ahead_ns} {
    for (std::uint64_t tick = 1; tick <= 10; ++tick) {
      const double at_ms = 10.0 * static_cast<double>(tick);
      state_comes(tick);
      wake_at(at_ms);
      demand_comes(tick);
      wake_at(at_ms + 0.5);
    }
    EXPECT_EQ(missing(), 0U);
  }

  void state_comes(std::uint64_t tick) {
    msg::State state{};
    state.header = header(tick);
    EXPECT_TRUE(states_.publish(state));
  }
  void demand_comes(std::uint64_t tick) {
    msg::Demand demand{};
    demand.header = header(tick);
    EXPECT_TRUE(demands_.publish(demand));
    msg::Reference reference{};
    reference.header = header(tick);
    EXPECT_TRUE(references_.publish(reference));
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

 private:
  [[nodiscard]] msg::Header header(std::uint64_t tick) const {
    msg::Header header{};
    header.tick = tick;
    header.sample_time_ns = kBegin_ns + bridge_ahead_ns_ + static_cast<std::int64_t>(tick) * 10'000'000;
    header.epoch = 1;
    return header;
  }
  std::int64_t bridge_ahead_ns_;
  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();
  bus::Bus plant_{runtime::memory_options(network_, "plant", crane_SOURCE_PLANT)};
  bus::Bus friction_{runtime::memory_options(network_, "friction_compensation", crane_SOURCE_FRICTION)};
  bus::Bus planner_{runtime::memory_options(network_, "planner", crane_SOURCE_PLANNER)};
  bus::Publisher<msg::State> states_ = plant_.publisher(topics::state);
  bus::Publisher<msg::Demand> demands_ = friction_.publisher(topics::demand);
  bus::Publisher<msg::Reference> references_ = planner_.publisher(topics::reference);
  bus::Subscriber<msg::SupervisorStatus> statuses_ = planner_.subscriber(topics::supervisor);
  configuration::Rig rig_ = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
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

TEST_P(RealTimeOnTwoHosts, SilenceIsJudgedByTheOwnClock) {
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

TEST_F(RealTime, CountsATickWhoseDemandDoesNotComeOnce) {
  state_comes(11);
  wake_at(110);
  sleep_until(119);
  EXPECT_EQ(missing(), 1U);
  EXPECT_EQ(steps(), 11);
}

TEST_F(RealTime, WaitsForTheDemandOfAStateThatCameLate) {
  state_comes(11);
  wake_at(114.5);
  sleep_until(118);  // 115 ms, a period and a half after state 10: the state is here, its demand is due
  EXPECT_EQ(steps(), 10);
  demand_comes(11);
  wake_at(118);
  EXPECT_EQ(missing(), 0U);
}

TEST_F(RealTime, APauseOfTheComputerIsNotThreeMissingTicks) {
  wake_at(127);  // 12 ms late: state 11 has come, and has not been handed over
  EXPECT_EQ(steps(), 10);
  state_comes(11);
  wake_at(127.1);
  state_comes(12);
  wake_at(141);  // paused again, 14 ms
  sleep_until(142);
  EXPECT_EQ(missing(), 0U);
  demand_comes(12);
  wake_at(142.1);
  EXPECT_EQ(missing(), 0U);
  EXPECT_FALSE(demand_is_stale());
}

TEST_F(RealTime, AStepThatCameLateIsNotFollowedByASecondOneAtOnce) {
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

TEST_F(RealTime, ThePausesOfItsOwnDelayTheJudgementByHalfAPeriodAStepAndNoMore) {
  for (double at_ms = 120; at_ms < 170; at_ms += 5.01) wake_at(at_ms);
  EXPECT_TRUE(state_is_stale());
}

TEST_F(RealTime, StatesThatComeAsOftenAsItIsWokenDoNotPutOffTheJudgementForEver) {
  for (std::uint64_t tick = 11; tick <= 25; ++tick) {  // never awake when the bound of a tick ends
    state_comes(tick);
    wake_at(10.0 * static_cast<double>(tick));
  }
  EXPECT_TRUE(demand_is_stale());
}

}  // namespace
}  // namespace crane::supervisor
