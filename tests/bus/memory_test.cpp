#include <gtest/gtest.h>

#include <cstring>
#include <thread>

#include "crane/bus/cdr.hpp"
#include "crane/bus/seal.hpp"
#include "memory_bus.hpp"
#include "random_sample.hpp"

namespace crane::bus {
namespace {

using namespace std::chrono_literals;

template <class T>
void expect_round_trip(const topics::Topic<T>& topic, Bus& from, Bus& to) {
  const CdrCodec& codec = CdrCodec::of(*topic.description.descriptor);
  testing::Random random{20'02};
  auto writer = from.publisher(topic);
  auto reader = to.subscriber(topic);
  for (int i = 0; i < 200; ++i) {
    T sample{};
    std::memcpy(&sample, testing::random_sample(codec, random).data(), sizeof sample);
    codec.make_texts_printable(&sample);
    ASSERT_TRUE(writer.publish(sample));
    seal(topic.description, &sample, from.options().source, from.options().epoch);
    const auto taken = reader.take();
    ASSERT_TRUE(taken) << topic.description.name;
    ASSERT_EQ(testing::encoded(codec, &*taken), testing::encoded(codec, &sample)) << topic.description.name;
  }
}

TEST_F(Memory, CarriesEveryTopicUnchanged) {
  Bus a = bus();
  Bus b = bus();
#define CRANE_MESSAGE(type)
#define CRANE_TOPIC(variable, ...) expect_round_trip(topics::variable, a, b);
#include "crane/topics.def"
#undef CRANE_TOPIC
#undef CRANE_MESSAGE
}

TEST_F(Memory, KeepsEverySampleInOrderUntilItIsTaken) {
  Bus a = bus();
  auto reader = a.subscriber(topics::state);
  auto writer = a.publisher(topics::state);
  Ticks expected;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    auto sample = state(tick);
    EXPECT_TRUE(writer.publish(sample));
    expected.push_back(tick);
  }
  EXPECT_EQ(ticks(reader), expected);
  EXPECT_EQ(reader.counts().taken, 1000U);
  EXPECT_EQ(reader.counts().rejected, 0U);
}

TEST_F(Memory, GivesEveryReaderItsOwnCopy) {
  Bus a = bus();
  Bus b = bus();
  auto first = a.subscriber(topics::state);
  auto second = b.subscriber(topics::state);
  auto writer = b.publisher(topics::state);
  auto sample = state(5);
  EXPECT_TRUE(writer.publish(sample));
  EXPECT_EQ(ticks(first), Ticks{5});
  EXPECT_EQ(ticks(second), Ticks{5});
}

TEST_F(Memory, WaitReturnsForAnEarlierSampleAndTimesOutWithoutASample) {
  Bus a = bus();
  auto reader = a.subscriber(topics::state);
  auto writer = a.publisher(topics::state);
  EXPECT_FALSE(a.wait(1ms));
  auto sample = state(1);
  EXPECT_TRUE(writer.publish(sample));
  EXPECT_TRUE(a.wait(0ms));
  EXPECT_FALSE(a.wait(1ms));
}

TEST_F(Memory, WaitWakesUpForAnotherThread) {
  Bus a = bus();
  Bus b = bus();
  auto reader = a.subscriber(topics::state);
  auto writer = b.publisher(topics::state);
  std::thread other{[&] {
    auto sample = state(1);
    EXPECT_TRUE(writer.publish(sample));
  }};
  EXPECT_TRUE(a.wait(10s));
  other.join();
  EXPECT_EQ(ticks(reader), Ticks{1});
}

TEST_F(Memory, HistoryReachesALateReaderThatAsksForItInOrderOfPublication) {
  Bus a = bus();
  auto one = a.publisher(topics::state, {.history = true});
  auto two = a.publisher(topics::state, {.history = true});
  for (std::uint64_t tick = 0; tick < 300; ++tick) {
    auto sample = state(tick);
    EXPECT_TRUE((tick % 2 == 0 ? one : two).publish(sample));
  }
  auto without = a.subscriber(topics::state);
  auto with = a.subscriber(topics::state, {.history = true});
  EXPECT_EQ(ticks(without), Ticks{});
  const Ticks taken = ticks(with);
  ASSERT_EQ(taken.size(), 256U);  // each writer keeps its last 128
  for (std::size_t i = 0; i < taken.size(); ++i) EXPECT_EQ(taken[i], 44 + i);
}

TEST_F(Memory, TheLastStatusOfEveryInstanceReachesALateReader) {
  Bus a = bus();
  auto writer = a.publisher(topics::node);
  for (std::uint32_t node : {1U, 2U, 3U, 2U}) {
    msg::NodeStatus status{};
    status.node = node;
    status.ticks = 10U + node;
    EXPECT_TRUE(writer.publish(status));
  }
  msg::NodeStatus gone{};
  gone.node = 3;
  EXPECT_TRUE(writer.dispose(gone));
  auto reader = a.subscriber(topics::node);
  std::vector<std::uint32_t> nodes;
  while (const auto status = reader.take()) nodes.push_back(status->node);
  EXPECT_EQ(nodes, (std::vector<std::uint32_t>{1, 2}));
}

TEST_F(Memory, TextsArePrintableAndHaveTheirOwnChecksum) {
  Bus a = bus();
  auto reader = a.subscriber(topics::event);
  auto writer = a.publisher(topics::event);
  msg::Event event{};
  std::memcpy(event.what, "\x1b[2J\nHOLD", 10);
  ASSERT_TRUE(writer.publish(event));
  const auto taken = reader.take();
  ASSERT_TRUE(taken);
  EXPECT_STREQ(taken->what, "?[2J HOLD");
  EXPECT_TRUE(intact(topics::event.description, &*taken));
}

TEST_F(Memory, ADisposedInstanceIsReportedOnRequest) {
  Bus a = bus();
  auto asks = a.subscriber(topics::node);
  auto does_not = a.subscriber(topics::node);
  auto writer = a.publisher(topics::node);
  msg::NodeStatus status{};
  status.node = 4;
  EXPECT_TRUE(writer.dispose(status));
  SampleInfo info;
  const auto sample = asks.take(&info);
  ASSERT_TRUE(sample);
  EXPECT_FALSE(info.valid);
  EXPECT_TRUE(info.disposed);
  EXPECT_EQ(sample->node, 4U);
  EXPECT_FALSE(does_not.take());
}

TEST_F(Memory, RefusesAStringWithoutTerminator) {
  Bus a = bus();
  auto writer = a.publisher(topics::event);
  msg::Event event{};
  std::memset(event.what, 'x', sizeof event.what);
  EXPECT_FALSE(writer.publish(event));
}

TEST_F(Memory, ReturnsTheBytesThatRecordingsStore) {
  Bus a = bus();
  auto reader = a.cdr_subscriber(topics::state.description);
  auto writer = a.publisher(topics::state);
  auto sample = state(77);
  EXPECT_TRUE(writer.publish(sample));
  std::vector<std::uint8_t> cdr;
  SampleInfo info;
  const auto header = reader.take(cdr, &info);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->tick, 77U);
  EXPECT_EQ(header->source, crane_SOURCE_PLANT);
  EXPECT_EQ(header->epoch, 3U);
  EXPECT_EQ(info.source_time_ns, sample.header.sample_time_ns);
  seal(topics::state.description, &sample, a.options().source, a.options().epoch);
  auto expected = testing::encoded(CdrCodec::of(crane_CraneState_desc), &sample);
  expected.insert(expected.begin(), {0, 1, 0, 0});
  EXPECT_EQ(cdr, expected);
  EXPECT_FALSE(reader.take(cdr));
}

TEST_F(Memory, DeliversEverythingFromManyThreads) {
  Bus a = bus();
  auto reader = a.subscriber(topics::state);
  constexpr std::uint64_t kEach = 2000;
  std::vector<std::thread> threads;
  threads.reserve(3);
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([this] {
      Bus own = bus();
      auto writer = own.publisher(topics::state);
      for (std::uint64_t tick = 0; tick < kEach; ++tick) {
        auto sample = state(tick);
        EXPECT_TRUE(writer.publish(sample));
      }
    });
  std::uint64_t taken = 0;
  while (taken < 3 * kEach && a.wait(10s)) taken += ticks(reader).size();
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(taken + ticks(reader).size(), 3 * kEach);
}

}  // namespace
}  // namespace crane::bus
