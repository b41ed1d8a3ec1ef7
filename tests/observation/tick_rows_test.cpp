/// Rows by tick: samples in any order, missing samples, restarts.
#include "observation/tick_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../recording/sample_recording.hpp"
#include "../recording/temporary_directory.hpp"
#include "samples.hpp"

namespace crane::observation {
namespace {

/// Rows of state.trolley_position_m, demand.total_v[0] and node.step_max_us.
class TickRowsTest : public testing::Test {
 protected:
  void state(std::uint64_t tick) {
    msg::State message{};
    message.trolley_position_m = static_cast<double>(tick);
    give(sample_of(topics::state, message, static_cast<std::int64_t>(tick) * kLoopPeriod_ns, tick));
  }
  void demand(std::uint64_t tick) {
    msg::Demand message{};
    message.total_v[0] = -static_cast<double>(tick);
    give(sample_of(topics::demand, message, 0, tick));
  }
  void node(double step_max_us) {
    msg::NodeStatus message{};
    message.step_max_us = step_max_us;
    give(sample_of(topics::node, message, 0, 0));
  }
  void give(const SamplePtr& sample) { rows_.add(sample->topic, sample->cdr); }

  static std::vector<Field> columns(const FieldTable& table) {
    FieldSelection selection{table};
    for (const char* name : {"state.trolley_position_m", "demand.total_v[0]", "node.step_max_us"})
      selection.add(name);
    return selection.columns();
  }
  [[nodiscard]] std::vector<std::uint64_t> ticks() const {
    std::vector<std::uint64_t> result;
    for (const auto& row : seen_) result.push_back(row.tick);
    return result;
  }

  FieldTable table_;
  std::vector<Row> seen_;
  TickRows rows_{table_, columns(table_), [this](const Row& row) { seen_.push_back(row); }};
};

TEST_F(TickRowsTest, RowIsCompleteWithTheLastSampleOfItsTick) {
  state(1);
  EXPECT_TRUE(seen_.empty());
  demand(1);
  ASSERT_EQ(seen_.size(), 1U);
  EXPECT_EQ(seen_[0].tick, 1U);
  EXPECT_EQ(seen_[0].time_ns, kLoopPeriod_ns);
  EXPECT_EQ(seen_[0].values[0], 1);
  EXPECT_EQ(seen_[0].values[1], -1);
  EXPECT_TRUE(std::isnan(seen_[0].values[2])) << "no report of a process yet";
}

TEST_F(TickRowsTest, TopicsThatAreReadOneAfterTheOtherMakeTheSameRows) {
  demand(1);
  demand(2);
  demand(3);
  state(1);
  EXPECT_THAT(ticks(), testing::ElementsAre(1));
  state(2);
  state(3);
  EXPECT_THAT(ticks(), testing::ElementsAre(1, 2, 3));
  for (const auto& row : seen_) EXPECT_EQ(row.values[1], -static_cast<double>(row.tick));
}

TEST_F(TickRowsTest, RowsAreCompleteForAnyLeadOfOneTopicWithinTheWait) {
  constexpr unsigned kSeed = 20034;
  constexpr std::uint64_t kTicks = 5000;
  std::mt19937 random{kSeed};
  std::uint64_t states = 0, demands = 0;
  while (states < kTicks || demands < kTicks) {
    const bool state_may = states < kTicks && states < demands + TickRows::kMostWaiting;
    const bool demand_may = demands < kTicks && demands < states + TickRows::kMostWaiting;
    const bool of_state = state_may && (!demand_may || random() % 2 == 0);
    for (auto burst = random() % 20 + 1; burst > 0; --burst) {
      if (of_state && states < kTicks && states < demands + TickRows::kMostWaiting) state(++states);
      if (!of_state && demands < kTicks && demands < states + TickRows::kMostWaiting) demand(++demands);
    }
  }
  ASSERT_EQ(seen_.size(), kTicks) << "seed " << kSeed;
  EXPECT_EQ(rows_.late(), 0U);
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    ASSERT_EQ(seen_[i].tick, i + 1) << "seed " << kSeed;
    ASSERT_EQ(seen_[i].values[0], -seen_[i].values[1]) << "seed " << kSeed;
  }
}

TEST_F(TickRowsTest, MissingSampleLeavesNanAndDelaysItsRowUntilALaterOneIsComplete) {
  state(1);
  state(2);
  demand(2);
  ASSERT_EQ(seen_.size(), 2U);
  EXPECT_TRUE(std::isnan(seen_[0].values[1]));
  EXPECT_EQ(seen_[1].values[1], -2);
  demand(1);
  EXPECT_EQ(rows_.late(), 1U);
}

TEST_F(TickRowsTest, SilentTopicDelaysRowsByTheLongestWaitOnly) {
  for (std::uint64_t tick = 1; tick <= 200; ++tick) state(tick);
  EXPECT_EQ(seen_.size(), 200 - TickRows::kMostWaiting);
  rows_.finish();
  EXPECT_EQ(seen_.size(), 200U);
}

TEST_F(TickRowsTest, TickWithoutStateHasNoRow) {
  demand(1);
  state(2);
  demand(2);
  EXPECT_THAT(ticks(), testing::ElementsAre(2));
}

TEST_F(TickRowsTest, FieldsOfTopicsWithoutATickKeepTheirNewestValue) {
  node(7);
  state(1);
  demand(1);
  state(2);
  demand(2);
  node(9);
  state(3);
  demand(3);
  ASSERT_EQ(seen_.size(), 3U);
  EXPECT_EQ(seen_[1].values[2], 7);
  EXPECT_EQ(seen_[2].values[2], 9);
}

TEST_F(TickRowsTest, ARestartedClockMasterBeginsANewSeries) {
  state(1000);
  demand(1000);
  demand(1);  // a sample of the new clock master, which cannot be distinguished from a late sample
  state(1);
  demand(1);
  state(2);
  demand(2);
  EXPECT_THAT(ticks(), testing::ElementsAre(1000, 1, 2));
}

TEST(TickRowsOfARecording, WithoutStateAreRefused) {
  const recording::TemporaryDirectory directory;
  recording::write_sample(directory / "run.mcap", 10);  // its schema has no types
  const FieldTable table{recording::McapReader{directory / "run.mcap"}};
  EXPECT_THROW((TickRows{table, {}, [](const Row&) {}}), std::invalid_argument);
}

}  // namespace
}  // namespace crane::observation
