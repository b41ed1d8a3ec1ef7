// Joins of equal ticks, bounded waits and counts, over the memory bus.
#include "crane/runtime/tick_join.hpp"

#include <gtest/gtest.h>

#include "crane/runtime/in_process.hpp"

namespace crane::runtime {
namespace {

class TickJoining : public testing::Test {
 protected:
  static constexpr std::int64_t kPeriod_ns = 10'000'000;
  using Join = TickJoin<msg::State, msg::Reference>;
  Join join(bool in_order) {
    return Join{
        {.in_order = in_order, .bound_ns = 4'000'000, .depth = 8, .period_ns = in_order ? 0 : kPeriod_ns},
        loop_reader(plant_, topics::state),
        loop_reader(plant_, topics::reference)};
  }
  void state(std::uint64_t tick) { publish(states_, tick); }
  void reference(std::uint64_t tick) { publish(references_, tick); }

 private:
  template <class T>
  static void publish(bus::Publisher<T>& publisher, std::uint64_t tick) {
    T sample{};
    sample.header.tick = tick;
    EXPECT_TRUE(publisher.publish(sample));
  }
  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();
  bus::Bus plant_{memory_options(network_, "plant", crane_SOURCE_PLANT)};
  bus::Bus planner_{memory_options(network_, "planner", crane_SOURCE_PLANNER)};
  bus::Publisher<msg::State> states_ = plant_.publisher(topics::state);
  bus::Publisher<msg::Reference> references_ = planner_.publisher(topics::reference);
};

TEST_F(TickJoining, CompletesWithTheSamplesOfTheSameTickOnly) {
  auto join = this->join(false);
  state(7);
  reference(8);
  EXPECT_EQ(join.poll(0), JoinResult::waiting);
  EXPECT_EQ(join.missing(), 2U);
  reference(7);
  ASSERT_EQ(join.poll(1), JoinResult::complete);
  EXPECT_EQ(join.tick(), 7U);
  EXPECT_EQ(join.get<1>()->header.tick, 7U);
  state(8);  // the join still has the reference that arrived early
  EXPECT_EQ(join.poll(2), JoinResult::complete);
}

TEST_F(TickJoining, GivesUpAfterTheBoundAndCountsTheTickLost) {
  auto join = this->join(false);
  state(1);
  EXPECT_EQ(join.poll(1'000'000), JoinResult::waiting);
  EXPECT_EQ(join.poll(4'999'999), JoinResult::waiting);
  EXPECT_EQ(join.poll(5'000'000), JoinResult::incomplete);
  EXPECT_EQ(join.get<1>(), nullptr);
  EXPECT_EQ(join.counts().lost, 1U);
}

TEST_F(TickJoining, ExtendsTheWaitOnceByHalfTheBoundAfterALateWakeUp) {
  auto join = this->join(false);
  state(1);
  EXPECT_EQ(join.poll(0), JoinResult::waiting);
  // After a pause, the bus may not have delivered the arrived samples yet.
  EXPECT_EQ(join.poll(20'000'000), JoinResult::waiting);
  EXPECT_EQ(join.due_ns(), 22'000'000);
  EXPECT_EQ(join.poll(40'000'000), JoinResult::incomplete);  // a second pause does not extend the wait again
  state(2);
  EXPECT_EQ(join.poll(40'000'000), JoinResult::waiting);
  EXPECT_EQ(join.poll(60'000'000), JoinResult::waiting);
  reference(2);
  EXPECT_EQ(join.poll(61'000'000), JoinResult::complete);
}

TEST_F(TickJoining, CountsGapsLateAndDuplicateSamples) {
  auto join = this->join(false);
  for (const auto tick : {1U, 5U}) {
    state(tick);
    reference(tick);
    ASSERT_EQ(join.poll(0), JoinResult::complete);
  }
  EXPECT_EQ(join.counts().lost, 3U);  // ticks 2, 3 and 4 never arrived
  reference(4);
  state(6);
  state(6);
  EXPECT_EQ(join.poll(0), JoinResult::waiting);
  EXPECT_EQ(join.counts().late, 1U);
  EXPECT_EQ(join.counts().duplicate, 1U);
}

TEST_F(TickJoining, AbandonsAnOldTickForTheNewestInRealTime) {
  auto join = this->join(false);
  state(1);
  EXPECT_EQ(join.poll(0), JoinResult::waiting);
  state(2);
  reference(2);
  ASSERT_EQ(join.poll(1), JoinResult::complete);
  EXPECT_EQ(join.tick(), 2U);
  EXPECT_EQ(join.counts().lost, 1U);
}

TEST_F(TickJoining, TakesEveryTickInOrderInLockstepWithoutATimeLimit) {
  auto join = this->join(true);
  for (std::uint64_t tick = 0; tick < 4; ++tick) state(tick);
  EXPECT_EQ(join.poll(1'000'000'000'000), JoinResult::waiting);
  for (std::uint64_t tick = 0; tick < 4; ++tick) reference(tick);
  for (std::uint64_t tick = 0; tick < 4; ++tick) {
    ASSERT_EQ(join.poll(0), JoinResult::complete);
    EXPECT_EQ(join.tick(), tick);
  }
  EXPECT_EQ(join.counts().lost, 0U);
}

TEST_F(TickJoining, ATickFarAheadIsDropped) {
  auto join = this->join(false);
  state(1);
  reference(1);
  ASSERT_EQ(join.poll(0), JoinResult::complete);
  for (const auto absurd : {~std::uint64_t{0}, std::uint64_t{1} << 40U, std::uint64_t{1000}}) state(absurd);
  EXPECT_EQ(join.poll(kPeriod_ns), JoinResult::waiting);
  EXPECT_EQ(join.counts().ahead, 3U);
  state(2);
  reference(2);
  EXPECT_EQ(join.poll(kPeriod_ns), JoinResult::complete);
  EXPECT_EQ(join.tick(), 2U);
}

TEST_F(TickJoining, ATickAfterAPauseOfTheBridgeIsAccepted) {
  auto join = this->join(false);
  state(1);
  reference(1);
  ASSERT_EQ(join.poll(0), JoinResult::complete);
  state(1001);  // ten seconds at 100 Hz
  reference(1001);
  EXPECT_EQ(join.poll(1000 * kPeriod_ns), JoinResult::complete);
}

TEST_F(TickJoining, AFloodOfSamplesDoesNotKeepAPollBusyForEver) {
  auto join = this->join(false);
  for (int i = 0; i < 2000; ++i) state(1);
  EXPECT_EQ(join.poll(0), JoinResult::waiting);
  EXPECT_EQ(join.counts().duplicate, LoopReader<msg::State>::kMostPerPoll - 1);
}

}  // namespace
}  // namespace crane::runtime
