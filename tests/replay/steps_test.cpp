// Which component stepped in a tick, and with which inputs, follows from the recorded samples.
#include "replay/steps.hpp"

#include <gtest/gtest.h>

#include "replay/recorded_tick.hpp"

namespace crane::replay {
namespace {

constexpr std::int64_t kPeriod_ns = 10'000'000;
constexpr std::uint64_t kTick = 300;

/// Two complete ticks; the samples of a tick are published 0.1 ms after each other.
class StepsOf : public testing::Test {
 protected:
  StepsOf() {
    now_.number = kTick;
    next_.number = kTick + 1;
    publish(now_, topics::reference, -6'000'000, time_ns(kTick - 1));
    publish(now_, topics::state, 0);
    publish(now_, topics::tracking, 100'000);
    publish(now_, topics::anti_swing, 200'000);
    publish(now_, topics::demand, 300'000);
    publish(now_, topics::command, 400'000);
    publish_status(500'000, 7);
    publish(next_, topics::reference, 600'000, time_ns(kTick));
    publish_next_state(kTick);
  }
  static std::int64_t time_ns(std::uint64_t tick) { return static_cast<std::int64_t>(tick) * kPeriod_ns; }
  /// @param at_ns  time of publication, from the state on
  template <class T>
  static void publish(RecordedTick& tick, const topics::Topic<T>& topic, std::int64_t at_ns,
                      std::optional<std::int64_t> sample_time_ns = std::nullopt, T sample = {}) {
    sample.header.tick = tick.number;
    sample.header.sample_time_ns = sample_time_ns.value_or(time_ns(tick.number));
    sample.header.epoch = 1;
    const auto& name = topic.description.name;
    tick.samples[name] = published(topic, sample);
    tick.published_ns[name] = time_ns(kTick) + at_ns;
  }
  void publish_status(std::int64_t at_ns, std::uint64_t missing_demand_count) {
    msg::SupervisorStatus status{};
    status.missing_demand_count = missing_demand_count;
    publish(now_, topics::supervisor, at_ns, std::nullopt, status);
  }
  void publish_next_state(std::uint64_t applied_command_tick) {
    msg::State state{};
    state.applied_command_tick = applied_command_tick;
    publish(next_, topics::state, kPeriod_ns, std::nullopt, state);
  }
  template <class T>
  static void omit(RecordedTick& tick, const topics::Topic<T>& topic) {
    tick.samples.erase(topic.description.name);
    tick.published_ns.erase(topic.description.name);
  }
  [[nodiscard]] Steps steps() const { return steps_of(now_, &next_, kPeriod_ns, 7); }
  RecordedTick now_, next_;
};

TEST_F(StepsOf, ACompleteTickIsRegular) {
  EXPECT_EQ(irregularity(steps()), "");
  EXPECT_EQ(steps().supervisor_after_ns, 500'000);
  EXPECT_FALSE(steps().planner_may_lack_status);
}

TEST_F(StepsOf, ADemandThatOnlyTheRecorderMissedWasPublished) {
  omit(now_, topics::demand);
  omit(now_, topics::tracking);
  EXPECT_EQ(irregularity(steps()), "") << "the supervisor counts no missing demand";
}

/// The recorder missed the status of the tick before, too.
TEST_F(StepsOf, ASupervisorThatCountsNoMissingDemandHadIt) {
  omit(now_, topics::demand);
  publish_status(500'000, 0);
  EXPECT_TRUE(steps_of(now_, &next_, kPeriod_ns, std::nullopt).supervisor_has_demand);
  publish_status(500'000, 1);
  EXPECT_FALSE(steps_of(now_, &next_, kPeriod_ns, std::nullopt).supervisor_has_demand);
}

TEST_F(StepsOf, ADemandThatTheSupervisorMissesWasNotPublished) {
  omit(now_, topics::demand);
  publish_status(500'000, 8);
  EXPECT_FALSE(steps().friction);
  EXPECT_TRUE(steps().tracking);
  EXPECT_FALSE(steps().supervisor_has_demand);
}

TEST_F(StepsOf, ALateDemandIsNotThatOfTheSupervisor) {
  publish_status(500'000, 8);
  EXPECT_TRUE(steps().friction);
  EXPECT_FALSE(steps().supervisor_has_demand);
  EXPECT_NE(irregularity(steps()), "");
}

TEST_F(StepsOf, AMissingStatusIsAStepOnlyIfItsCommandWasApplied) {
  omit(now_, topics::supervisor);
  omit(now_, topics::command);
  EXPECT_TRUE(steps().supervisor);
  publish_next_state(kTick - 1);
  EXPECT_FALSE(steps().supervisor);
  EXPECT_FALSE(steps().planner_has_status);
}

TEST_F(StepsOf, APlannerThatPublishedBeforeTheStatusDidNotHaveIt) {
  publish_status(8'500'000, 7);
  publish(next_, topics::reference, 8'100'000, time_ns(kTick));
  EXPECT_FALSE(steps().planner_has_status);
  EXPECT_FALSE(steps().planner_may_lack_status);
}

TEST_F(StepsOf, APlannerThatPublishedLateMayLackAStatus) {
  publish_status(7'000'000, 7);
  publish(next_, topics::reference, 8'100'000, time_ns(kTick));
  EXPECT_TRUE(steps().planner_has_status);
  EXPECT_TRUE(steps().planner_may_lack_status);
}

TEST_F(StepsOf, AReferenceOfTheStateOfItsTickShowsThatThePlannerBegan) {
  publish(now_, topics::reference, 50'000);
  EXPECT_TRUE(steps().planner_begins);
  publish(next_, topics::reference, kPeriod_ns + 50'000, time_ns(kTick + 1));
  EXPECT_FALSE(steps().planner) << "the planner began again with the next tick";
}

TEST_F(StepsOf, AReferenceThatTheLawsUsedWasPublished) {
  omit(next_, topics::reference);
  EXPECT_FALSE(steps().planner);
  publish(next_, topics::tracking, kPeriod_ns + 100'000);
  EXPECT_TRUE(steps().planner);
}

TEST_F(StepsOf, AReferenceThatWasPublishedAfterTheStatusIsNotThatOfTheSupervisor) {
  publish(now_, topics::reference, 600'000);
  EXPECT_FALSE(steps().supervisor_has_reference);
}

}  // namespace
}  // namespace crane::replay
