// The process of the supervisor in real time: counts of missing ticks when samples are late or the process is
// scheduled late. Times in ms.
#include <gtest/gtest.h>

#include <limits>

#include "supervisor_in_real_time.hpp"

namespace crane::supervisor {
namespace {

using RealTime = SupervisorInRealTime;

class RealTimeOnTwoHosts : public SupervisorInRealTime, public testing::WithParamInterface<std::int64_t> {
 protected:
  RealTimeOnTwoHosts() : SupervisorInRealTime{GetParam()} {}
};

class SupervisorBeforeItsFirstStep : public SupervisorInRealTime {
 protected:
  SupervisorBeforeItsFirstStep() : SupervisorInRealTime{0, true, 0} {}
  void states_come(std::uint64_t first, std::uint64_t last) {
    for (auto tick = first; tick <= last; ++tick) {
      state_comes(tick);
      wake_at(10.0 * static_cast<double>(tick));
      sleep_until(10.0 * static_cast<double>(tick) + 9);
    }
  }
};

TEST_F(SupervisorBeforeItsFirstStep, WaitsForTheFirstTickWithAllInputs) {
  states_come(1, 20);
  EXPECT_EQ(steps(), 0);
  state_comes(21);
  wake_at(210);
  demand_comes(21);
  wake_at(210.5);
  EXPECT_EQ(steps(), 1);
  EXPECT_EQ(missing(), 0U);
  states_come(22, 22);
  EXPECT_EQ(steps(), 2);
  EXPECT_EQ(missing(), 1U);
}

TEST_F(SupervisorBeforeItsFirstStep, ReportsAMissingDemandTwoSecondsAfterTheFirstState) {
  states_come(1, 200);
  EXPECT_EQ(steps(), 0);
  states_come(201, 205);
  EXPECT_GE(steps(), 4);
  EXPECT_TRUE(demand_is_stale());
}

TEST_F(SupervisorBeforeItsFirstStep, ReportsAMissingStateTwoSecondsAfterTheOnlyState) {
  states_come(1, 1);
  sleep_until(2009);
  EXPECT_EQ(steps(), 0);
  sleep_until(2050);
  EXPECT_GE(steps(), 2);
  EXPECT_TRUE(state_is_stale());
}

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
  // At 115 ms, one and a half periods after state 10, this state has arrived and its demand is due.
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

TEST_F(RealTime, ThreeStepsWithoutStateCauseStateStale) {
  sleep_until(129.9);
  EXPECT_EQ(steps(), 11);
  EXPECT_FALSE(state_is_stale());
  sleep_until(145.1);  // 115, 130 and 145 ms
  EXPECT_EQ(steps(), 13);
  EXPECT_TRUE(state_is_stale());
}

TEST_F(RealTime, PausesOfTheProcessDelayAStepByAtMostHalfAPeriod) {
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

TEST_F(RealTime, FrequentStatesDoNotDelayTheStepIndefinitely) {
  for (std::uint64_t tick = 11; tick <= 25;
       ++tick) {  // the process is never awake at the end of the wait of a tick
    state_comes(tick);
    wake_at(10.0 * static_cast<double>(tick));
  }
  EXPECT_TRUE(demand_is_stale());
}

}  // namespace
}  // namespace crane::supervisor
