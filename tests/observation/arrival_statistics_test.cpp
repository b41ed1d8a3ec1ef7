#include "observation/arrival_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace crane::observation {
namespace {

constexpr std::int64_t kPeriod_ns = 10'000'000;

Arrival on_time(std::uint64_t tick, std::int64_t delay_ns = 0) {
  const auto sampled_ns = static_cast<std::int64_t>(tick) * kPeriod_ns;
  return {.tick = tick, .epoch = 1, .source_time_ns = sampled_ns, .arrival_time_ns = sampled_ns + delay_ns};
}

TEST(ArrivalStatistics, GiveTheRateOfTheSourceAlsoInABurst) {
  ArrivalStatistics statistics{true};
  for (const std::uint64_t tick : {3U, 4U}) statistics.add(on_time(tick));
  for (std::uint64_t tick = 5; tick <= 105; ++tick) {
    auto arrival = on_time(tick);
    arrival.arrival_time_ns = 50'000'000;
    statistics.add(arrival);
  }
  const auto window = statistics.take_window();
  EXPECT_DOUBLE_EQ(window.rate_hz.value(), 100.0);
  EXPECT_DOUBLE_EQ(window.jitter_us->max, 10'000.0);
  EXPECT_EQ(statistics.counts().lost, 0U);
}

/// A writer sends its whole history of 128 samples to a reader that joins.
TEST(ArrivalStatistics, DoNotCountTheHistoryOfTheWriterAsJitter) {
  constexpr std::int64_t kBurst_ns = 20'000;
  ArrivalStatistics statistics{true};
  std::int64_t arrival_ns = 0;
  for (std::uint64_t tick = 0; tick < 228; ++tick) {
    arrival_ns += tick < 128 ? kBurst_ns : kPeriod_ns + (tick % 2 == 0 ? 50'000 : -50'000);
    statistics.add({tick, 1, static_cast<std::int64_t>(tick) * kPeriod_ns, arrival_ns});
  }
  const auto window = statistics.take_window();
  ASSERT_TRUE(window.jitter_us);
  EXPECT_NEAR(window.jitter_us->max, 50, 1e-6);
  EXPECT_NEAR(window.rate_hz.value_or(0), 100, 1e-6);
}

TEST(ArrivalStatistics, DoNotCountTheJoiningOfTheReaderAsJitter) {
  constexpr std::int64_t kDelay_ns = 300'000;
  for (const std::uint64_t held : {1U, 3U}) {  // samples that come together with the next one
    ArrivalStatistics statistics{true};
    for (std::uint64_t tick = 0; tick < 100; ++tick)
      statistics.add(
          on_time(tick, kDelay_ns + (tick < held ? static_cast<std::int64_t>(held - tick) * kPeriod_ns : 0)));
    EXPECT_DOUBLE_EQ(statistics.take_window().jitter_us->max, 0.0) << held;
    statistics.add(on_time(100, kDelay_ns + kPeriod_ns));
    statistics.add(on_time(101, kDelay_ns));
    EXPECT_DOUBLE_EQ(statistics.take_window().jitter_us->max, 10'000.0) << "later it is jitter";
  }
}

TEST(ArrivalStatistics, DistinguishLostLateAndDuplicateSamples) {
  ArrivalStatistics statistics{true};
  for (const std::uint64_t tick : {1U, 2U, 6U, 4U, 6U, 2U, 7U}) statistics.add(on_time(tick));
  const auto counts = statistics.counts();
  EXPECT_EQ(counts.samples, 7U);
  EXPECT_EQ(counts.lost, 2U);       // 3 and 5
  EXPECT_EQ(counts.late, 1U);       // 4
  EXPECT_EQ(counts.duplicate, 2U);  // 6 and 2
}

TEST(ArrivalStatistics, CountTheLossesOfAnyGap) {
  ArrivalStatistics statistics{true};
  statistics.add(on_time(0));
  statistics.add(on_time(1'000'000));
  statistics.add(on_time(2'000'000));
  EXPECT_EQ(statistics.counts().lost, 1'999'998U);
}

TEST(ArrivalStatistics, RestartWhenAnotherWriterTakesOver) {
  ArrivalStatistics statistics{true};
  statistics.add(on_time(5'000));
  auto restarted = on_time(1);
  restarted.epoch = 2;
  statistics.add(restarted);
  EXPECT_EQ(statistics.counts().restarts, 1U);
  EXPECT_EQ(statistics.counts().duplicate, 0U);
  EXPECT_FALSE(statistics.take_window().rate_hz.has_value());
}

TEST(ArrivalStatistics, CarryTheIntervalBetweenTwoWindows) {
  ArrivalStatistics statistics{true};
  statistics.add(on_time(0));
  EXPECT_FALSE(statistics.take_window().rate_hz.has_value());
  statistics.add(on_time(1));
  EXPECT_DOUBLE_EQ(statistics.take_window().rate_hz.value(), 100.0);
  EXPECT_EQ(statistics.take_window().samples, 0U);
}

TEST(ArrivalStatistics, GiveNoLossesForTopicsThatAreNotWrittenEveryTick) {
  ArrivalStatistics statistics{false};
  for (const std::uint64_t tick : {100U, 200U, 200U}) statistics.add(on_time(tick));
  EXPECT_EQ(statistics.counts().lost, 0U);
  EXPECT_EQ(statistics.counts().duplicate, 0U);
}

TEST(ArrivalStatistics, CountEveryTickOfARandomStreamOnce) {
  constexpr unsigned kSeed = 20240517;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random{kSeed};
  std::vector<std::uint64_t> sent;
  std::uint64_t lost = 0, doubled = 0;
  for (std::uint64_t tick = 1; tick < 3000; ++tick) {
    const auto fate = random() % 10;
    if (fate == 0) ++lost;
    if (fate > 0) sent.push_back(tick);
    if (fate == 1) sent.push_back(tick), ++doubled;
  }
  sent.insert(sent.begin(), 0);
  sent.push_back(3000);
  for (std::size_t i = 1; i + 3 < sent.size(); i += 3) std::shuffle(&sent[i], &sent[i + 3], random);
  ArrivalStatistics statistics{true};
  for (const auto tick : sent) statistics.add(on_time(tick));
  EXPECT_EQ(statistics.counts().lost, lost);
  EXPECT_EQ(statistics.counts().duplicate, doubled);
}

TEST(Percentile, IsTheNearestRank) {
  std::vector<double> values(100);
  std::iota(values.rbegin(), values.rend(), 1.0);
  EXPECT_EQ(percentile(values, 0.5), 50.0);
  EXPECT_EQ(percentile(values, 0.99), 99.0);
  EXPECT_EQ(percentile(values, 0.0), 1.0);
  EXPECT_EQ(percentile(values, 1.0), 100.0);
  EXPECT_EQ(percentile({}, 0.5), std::nullopt);
}

}  // namespace
}  // namespace crane::observation
