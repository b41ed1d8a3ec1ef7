#include <gtest/gtest.h>

#include <cstring>
#include <thread>

#include "crane/bus/bus.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/bus/seal.hpp"
#include "random_sample.hpp"

namespace crane::bus {
namespace {

using namespace std::chrono_literals;

class Memory : public ::testing::Test {
 protected:
  [[nodiscard]] Bus bus(const std::string& crane = "crane") const {
    return Bus{{.vendor = Vendor::memory,
                .crane = crane,
                .source = crane_SOURCE_PLANT,
                .epoch = 3,
                .network = network_}};
  }
  static msg::State state(std::uint64_t tick) {
    msg::State sample{};
    sample.header.tick = tick;
    sample.header.sample_time_ns = static_cast<std::int64_t>(tick) * 10'000'000;
    return sample;
  }
  static std::vector<std::uint64_t> ticks(Subscriber<msg::State>& reader) {
    std::vector<std::uint64_t> taken;
    while (const auto sample = reader.take()) taken.push_back(sample->header.tick);
    return taken;
  }

  std::shared_ptr<MemoryNetwork> network_ = make_memory_network();
};

using Ticks = std::vector<std::uint64_t>;

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

TEST_F(Memory, TwoCranesDoNotSeeEachOtherAndAStarSeesBoth) {
  Bus north = bus("north");
  Bus south = bus("south");
  Bus all = bus("*");
  auto north_reader = north.subscriber(topics::state);
  auto south_reader = south.subscriber(topics::state);
  auto all_reader = all.subscriber(topics::state);
  auto north_writer = north.publisher(topics::state);
  auto south_writer = south.publisher(topics::state);
  auto sample = state(1);
  EXPECT_TRUE(north_writer.publish(sample));
  sample = state(2);
  EXPECT_TRUE(south_writer.publish(sample));
  EXPECT_EQ(ticks(north_reader), Ticks{1});
  EXPECT_EQ(ticks(south_reader), Ticks{2});
  EXPECT_EQ(ticks(all_reader), (Ticks{1, 2}));
}

TEST_F(Memory, ReportsMatchedAndUnmatchedEndpointsWithTheirNumber) {
  Bus a = bus();
  std::vector<std::string> events;
  const auto note = [&events](const Event& event) {
    events.push_back(std::string{to_string(event.kind)} + " " + std::to_string(event.current));
  };
  auto writer = a.publisher(topics::state, {.on_event = note});
  EXPECT_EQ(writer.matched(), 0);
  {
    auto reader = a.subscriber(topics::state);
    EXPECT_EQ(writer.matched(), 1);
    EXPECT_EQ(reader.matched(), 1);
    auto other_topic = a.subscriber(topics::command);
    EXPECT_EQ(other_topic.matched(), 0);
  }
  EXPECT_EQ(writer.matched(), 0);
  EXPECT_EQ(events, (std::vector<std::string>{"matched 1", "unmatched 0"}));
}

TEST_F(Memory, AHandlerMayCallTheBus) {
  Bus a = bus();
  auto writer = a.publisher(topics::state);
  int seen = -1;
  auto reader = a.subscriber(topics::state, {.on_event = [&](const Event&) { seen = writer.matched(); }});
  EXPECT_EQ(seen, 1);
}

TEST_F(Memory, EndpointsSurviveTheirBus) {
  auto a = std::make_unique<Bus>(bus());
  auto writer = a->publisher(topics::state);
  auto reader = a->subscriber(topics::state);
  a.reset();
  network_.reset();
  auto sample = state(9);
  EXPECT_TRUE(writer.publish(sample));
  EXPECT_EQ(ticks(reader), Ticks{9});
}

/// A share is a bus of its own on the same participant.
TEST_F(Memory, ASharedParticipantDeliversToItsOtherBusWithTheSourceOfEach) {
  auto first = bus();
  auto second = first.share(crane_SOURCE_SUPERVISOR, 4);
  auto statuses_in = first.subscriber(topics::supervisor);
  auto states_in = second.subscriber(topics::state);
  auto states_out = first.publisher(topics::state);
  auto statuses_out = second.publisher(topics::supervisor);

  EXPECT_TRUE(states_out.publish(state(1)));
  EXPECT_TRUE(second.wait(0ns));
  EXPECT_FALSE(first.wait(0ns)) << "the sample is for the other bus";
  EXPECT_TRUE(statuses_out.publish({}));
  SampleInfo of_state, of_status;
  const auto seen_state = states_in.take(&of_state);
  const auto seen_status = statuses_in.take(&of_status);
  ASSERT_TRUE(seen_state && seen_status);
  EXPECT_EQ(seen_state->header.source, crane_SOURCE_PLANT);
  EXPECT_EQ(seen_state->header.epoch, 3U);
  EXPECT_EQ(seen_status->header.source, crane_SOURCE_SUPERVISOR);
  EXPECT_EQ(seen_status->header.epoch, 4U);
  EXPECT_EQ(of_state.participant, of_status.participant);
  EXPECT_NE(of_state.writer, of_status.writer);
}

TEST_F(Memory, RefusesAStringWithoutItsEnd) {
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
