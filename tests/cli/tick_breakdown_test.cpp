// The breakdown by crane bench tick: whatever the stamps are, the parts of a tick add up to its latency.
#include "cli/tick_breakdown.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include "stack/stack.hpp"

namespace crane::cli {
namespace {

using bus::PathRecord;

std::size_t topic_of(const topics::Description& topic) { return bus::index_of(topic.name); }

/// Stamps of a stack whose every step takes a random time.
class RandomStack {
 public:
  explicit RandomStack(unsigned seed) : random_{seed}, records_(processes().size()) {
    isolated_.udp_hop_ns = 20'000;
    for (auto& share : isolated_.codec_share) share = std::uniform_real_distribution{0.0, 1.0}(random_);
  }

  /// Adds the stamps of one tick. @return time from the latch to the arrival of the command
  std::int64_t add_tick(std::uint64_t tick) {
    const auto latched_ns = static_cast<std::int64_t>(tick + 1) * 10'000'000;
    const auto read_ns = latched_ns + some_ns();
    auto bridge = published(topics::state.description, tick, latched_ns, read_ns);
    bridge.joined_ns = read_ns;
    if (command_arrived_ns_ > 0)
      bridge.arrived_ns[topic_of(topics::command.description)] = command_arrived_ns_;
    records_[0].push_back(bridge);
    const auto tracking = step(2, topics::tracking.description, tick, latched_ns, {bridge});
    const auto anti_swing = step(3, topics::anti_swing.description, tick, latched_ns, {bridge});
    const auto demand = step(4, topics::demand.description, tick, latched_ns, {bridge, tracking, anti_swing});
    const auto command = step(5, topics::command.description, tick, latched_ns, {bridge, demand});
    slower_law_[tick] = demand.arrived_ns[tracking.topic] > demand.arrived_ns[anti_swing.topic] ? 2 : 3;
    command_arrived_ns_ = command.sealed_ns + some_ns();
    return command_arrived_ns_ - latched_ns;
  }
  /// The tick begins, and one process does not publish its sample.
  void lose(std::uint64_t tick, std::size_t process) {
    std::erase_if(records_[process], [tick](const PathRecord& record) { return record.tick == tick; });
  }

  [[nodiscard]] TickBreakdown breakdown() const { return break_down(processes(), records_, isolated_); }
  [[nodiscard]] std::size_t slower_law(std::uint64_t tick) const { return slower_law_.at(tick); }
  [[nodiscard]] static const std::vector<runtime::ComponentSpec>& processes() {
    static const auto specs = stack::hardware_stack();
    return specs;
  }

 private:
  std::int64_t some_ns() { return std::uniform_int_distribution{0, 100'000}(random_); }

  PathRecord published(const topics::Description& topic, std::uint64_t tick, std::int64_t latched_ns,
                       std::int64_t begin_ns) {
    PathRecord record{.topic = topic_of(topic), .tick = tick, .sample_time_ns = latched_ns};
    record.published_ns = begin_ns + some_ns();
    record.sealed_ns = record.published_ns + some_ns();
    record.written_ns = record.sealed_ns + some_ns();
    return record;
  }
  /// A process publishes when all inputs have arrived. An input may arrive before the write of its sender has
  /// returned, and during a poll that has begun already.
  PathRecord step(std::size_t process, const topics::Description& topic, std::uint64_t tick,
                  std::int64_t latched_ns, const std::vector<PathRecord>& inputs) {
    std::int64_t last_ns = 0, arrived_ns[topics::kAll.size()] = {};
    for (const auto& input : inputs) {
      arrived_ns[input.topic] = input.sealed_ns + some_ns();
      last_ns = std::max(last_ns, arrived_ns[input.topic]);
    }
    const auto joined_ns = last_ns + some_ns();
    auto record = published(topic, tick, latched_ns, joined_ns);
    std::ranges::copy(arrived_ns, record.arrived_ns.begin());
    record.polled_ns = joined_ns - some_ns();
    record.taking_ns = some_ns();
    record.checking_ns = some_ns();
    record.joined_ns = joined_ns;
    records_[process].push_back(record);
    return record;
  }

  std::mt19937 random_;
  std::vector<std::vector<PathRecord>> records_;
  Isolated isolated_;
  std::int64_t command_arrived_ns_ = 0;
  std::map<std::uint64_t, std::size_t> slower_law_;
};

TEST(TickBreakdown, PartsOfEveryTickAddUpToItsLatency) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomStack stack{seed};
    std::vector<std::int64_t> latencies_ns;
    for (std::uint64_t tick = 0; tick < 21; ++tick) latencies_ns.push_back(stack.add_tick(tick));
    const auto breakdown = stack.breakdown();
    ASSERT_EQ(breakdown.ticks.size(), 20U);  // the last command has not arrived yet
    EXPECT_EQ(breakdown.left_out, 0U);
    for (const auto& tick : breakdown.ticks) {
      const auto parts_ns = sum_of_hops(tick);
      EXPECT_EQ(std::accumulate(parts_ns.begin(), parts_ns.end(), std::int64_t{0}), tick.latency_ns);
      EXPECT_EQ(tick.latency_ns, latencies_ns[tick.tick]);
      for (const auto& hop : tick.hops) EXPECT_THAT(hop.parts_ns, testing::Each(testing::Ge(0)));
    }
  }
}

TEST(TickBreakdown, PathLeadsThroughTheSlowerLawAndBackToTheBridge) {
  RandomStack stack{7};
  for (std::uint64_t tick = 0; tick < 50; ++tick) stack.add_tick(tick);
  const auto breakdown = stack.breakdown();
  for (const auto& tick : breakdown.ticks) {
    std::vector<std::size_t> route;
    for (const auto& hop : tick.hops) route.push_back(hop.to);
    EXPECT_THAT(route, testing::ElementsAre(stack.slower_law(tick.tick), 4, 5, 0)) << "tick " << tick.tick;
  }
}

TEST(TickBreakdown, TickWithoutACompletePathIsLeftOut) {
  RandomStack stack{3};
  for (std::uint64_t tick = 0; tick < 10; ++tick) stack.add_tick(tick);
  stack.lose(4, 5);
  stack.lose(6, 4);
  const auto breakdown = stack.breakdown();
  EXPECT_EQ(breakdown.left_out, 2U);
  EXPECT_EQ(breakdown.ticks.size(), 7U);
  for (const auto& tick : breakdown.ticks)
    EXPECT_THAT(tick.tick, testing::AllOf(testing::Ne(4U), testing::Ne(6U)));
}

TEST(TickBreakdown, TheKernelsPartIsAtMostOneUdpHop) {
  RandomStack stack{11};
  for (std::uint64_t tick = 0; tick < 20; ++tick) stack.add_tick(tick);
  const auto breakdown = stack.breakdown();
  for (const auto& tick : breakdown.ticks)
    for (const auto& hop : tick.hops) {
      const auto kernel_ns = hop.parts_ns[static_cast<std::size_t>(Part::kernel)];
      EXPECT_LE(kernel_ns, 20'000);
      const bool has_rest = hop.parts_ns[static_cast<std::size_t>(Part::vendor)] > 0;
      EXPECT_TRUE(!has_rest || kernel_ns == 20'000) << "tick " << tick.tick;
    }
}

}  // namespace
}  // namespace crane::cli
