// Samples of one vendor arrive unchanged at the other one; history, instances and partitions behave equally.
#include <atomic>
#include <cstring>
#include <optional>
#include <string_view>

#include "../bus/random_sample.hpp"
#include "crane/bus/seal.hpp"
#include "stage.hpp"

namespace crane::bus::testing {
namespace {

class Samples : public ::testing::TestWithParam<VendorPair> {
 protected:
  Samples() : from{options(GetParam().writer, 42)}, to{options(GetParam().reader, 42)} {}
  Bus from, to;
};

template <class T>
void expect_unchanged(const topics::Topic<T>& topic, Bus& from, Bus& to) {
  constexpr std::uint64_t kSeed = 1986;
  constexpr int kSamples = 60;
  const CdrCodec& codec = CdrCodec::of(*topic.description.descriptor);
  auto writer = from.publisher(topic);
  auto reader = to.subscriber(topic);
  auto bytes_reader = to.cdr_subscriber(topic.description);
  ASSERT_TRUE(eventually(
      to, [&] { return writer.matched() == 2 && bytes_reader.matched() == 1 && reader.matched() == 1; }));
  Random random{kSeed};
  for (int i = 0; i < kSamples; ++i) {
    T sample{};
    std::memcpy(&sample, random_sample(codec, random).data(), sizeof sample);
    codec.make_texts_printable(&sample);
    if constexpr (std::is_same_v<T, msg::NodeStatus>) sample.node %= 16;  // a crane has few processes
    ASSERT_TRUE(writer.publish(sample));
    SampleInfo info;
    const auto taken = next(to, reader, &info);
    ASSERT_TRUE(taken) << topic.description.name << ", seed " << kSeed << ", sample " << i;
    seal(topic.description, &sample, crane_SOURCE_PLANT, 11);  // as publish() does
    auto expected = encoded(codec, &sample);
    ASSERT_EQ(encoded(codec, &*taken), expected) << topic.description.name << ", seed " << kSeed;
    EXPECT_EQ(taken->header.source, crane_SOURCE_PLANT);
    EXPECT_EQ(taken->header.epoch, 11U);
    EXPECT_GT(info.source_time_ns, 0);

    std::vector<std::uint8_t> bytes;
    ASSERT_TRUE(eventually(to, [&] { return bytes_reader.take(bytes).has_value(); }));
    expected.insert(expected.begin(), {0, 1, 0, 0});
    ASSERT_EQ(bytes, expected) << topic.description.name;
  }
  EXPECT_EQ(reader.counts().taken, static_cast<std::uint64_t>(kSamples));
  EXPECT_EQ(reader.counts().rejected, 0U);
}

#define CRANE_MESSAGE(type)
#define CRANE_TOPIC(variable, ...) \
  TEST_P(Samples, ArriveUnchangedOn_##variable) { expect_unchanged(topics::variable, from, to); }
#include "crane/topics.def"
#undef CRANE_MESSAGE
#undef CRANE_TOPIC

msg::State state(std::uint64_t tick) {
  msg::State sample{};
  sample.header.tick = tick;
  return sample;
}

TEST_P(Samples, OfALockstepChunkArriveCompleteAndInOrder) {
  constexpr std::uint64_t kChunk = 128;
  auto writer = from.publisher(topics::state);
  auto reader = to.subscriber(topics::state);
  ASSERT_TRUE(matched(to, writer, reader));
  for (std::uint64_t tick = 0; tick < kChunk; ++tick) {
    auto sample = state(tick);
    ASSERT_TRUE(writer.publish(sample));
  }
  for (std::uint64_t tick = 0; tick < kChunk; ++tick) {
    const auto sample = next(to, reader);
    ASSERT_TRUE(sample) << "tick " << tick;
    ASSERT_EQ(sample->header.tick, tick);
  }
}

TEST_P(Samples, ThatAreAcknowledgedCanBeTakenAtOnce) {
  constexpr std::uint64_t kSamples = 20;
  auto writer = from.publisher(topics::jog);
  auto reader = to.subscriber(topics::jog);
  ASSERT_TRUE(matched(to, writer, reader));
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    msg::Jog sample{};
    sample.header.tick = i;
    ASSERT_TRUE(writer.publish(sample));
    ASSERT_TRUE(writer.wait_until_acknowledged(kPatience));
    const auto taken = reader.take();
    ASSERT_TRUE(taken) << "sample " << i;
    ASSERT_EQ(taken->header.tick, i);
  }
}

TEST_P(Samples, ArriveWithoutAReaderAtNobody) {
  auto writer = from.publisher(topics::jog);
  ASSERT_TRUE(writer.publish({}));
  EXPECT_TRUE(writer.wait_until_acknowledged(kPatience));
}

TEST_P(Samples, AreAnsweredOnArrival) {
  constexpr std::uint64_t kTicks = 500;
  std::atomic<bool> ready = false;
  std::atomic<int> unsent = 0;
  std::optional<Subscriber<msg::State>> states;
  std::optional<Publisher<msg::Reference>> answers;
  to.call_on_arrival([&](std::string_view /*topic*/) {
    if (!ready) return;
    while (const auto sample = states->take()) {
      msg::Reference answer{};
      answer.header = sample->header;
      if (!answers->publish(answer)) ++unsent;
    }
  });
  states.emplace(to.subscriber(topics::state));
  answers.emplace(to.publisher(topics::reference));
  auto writer = from.publisher(topics::state);
  auto reader = from.subscriber(topics::reference);
  ASSERT_TRUE(matched(from, writer, reader) && matched(from, *answers, *states));
  ready = true;
  for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
    auto sample = state(tick);
    ASSERT_TRUE(writer.publish(sample));
    const auto answer = next(from, reader);
    ASSERT_TRUE(answer) << "tick " << tick;
    ASSERT_EQ(answer->header.tick, tick);
  }
  EXPECT_EQ(unsent, 0);
}

TEST_P(Samples, OfThePastReachALateReaderWhenBothSidesAskForIt) {
  auto writer = from.publisher(topics::state, {.history = true});
  for (std::uint64_t tick = 0; tick < 5; ++tick) {
    auto sample = state(tick);
    ASSERT_TRUE(writer.publish(sample));
  }
  auto late = to.subscriber(topics::state, {.history = true});
  for (std::uint64_t tick = 0; tick < 5; ++tick) {
    const auto sample = next(to, late);
    ASSERT_TRUE(sample) << "tick " << tick;
    EXPECT_EQ(sample->header.tick, tick);
  }
}

TEST_P(Samples, OfThePastDoNotReachAReaderOfAnOrdinaryWriter) {
  auto writer = from.publisher(topics::request);
  msg::Request request{};
  for (request.id = 1; request.id <= 5; ++request.id) ASSERT_TRUE(writer.publish(request));
  auto reader = to.subscriber(topics::request);
  ASSERT_TRUE(matched(to, writer, reader));
  ASSERT_TRUE(writer.publish(request));
  const auto first = next(to, reader);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->id, 6U);
}

TEST_P(Samples, OfRequestsAndEventsReachALateReaderThatAsks) {
  auto requests = from.publisher(topics::request, {.history = true});
  auto events = from.publisher(topics::event);
  msg::Request request{};
  request.id = 17;
  msg::Event event{};
  std::strcpy(event.code, "motor_hot");
  ASSERT_TRUE(requests.publish(request));
  ASSERT_TRUE(events.publish(event));
  auto late_requests = to.subscriber(topics::request, {.history = true});
  auto late_events = to.subscriber(topics::event, {.history = true});
  const auto got_request = next(to, late_requests);
  ASSERT_TRUE(got_request);
  EXPECT_EQ(got_request->id, 17U);
  const auto got_event = next(to, late_events);
  ASSERT_TRUE(got_event);
  EXPECT_STREQ(got_event->code, "motor_hot");
}

TEST_P(Samples, OfStatusReachALateReaderOncePerInstance) {
  auto writer = from.publisher(topics::node);
  for (const std::uint32_t node : {1U, 2U, 1U}) {
    msg::NodeStatus status{};
    status.node = node;
    status.ticks = node == 1 ? 100 : 200;
    ASSERT_TRUE(writer.publish(status));
  }
  auto late = to.subscriber(topics::node);
  const auto first = next(to, late);
  const auto second = next(to, late);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->node + second->node, 3U);
  EXPECT_EQ(first->ticks + second->ticks, 300U);
  EXPECT_FALSE(late.take());
}

TEST_P(Samples, NameTheParticipantOfTheirWriter) {
  Bus other{options(GetParam().writer, 42)};
  auto requests = from.publisher(topics::request);
  auto jogs = from.publisher(topics::jog), others = other.publisher(topics::jog);
  auto request_reader = to.subscriber(topics::request);
  auto jog_reader = to.subscriber(topics::jog);
  ASSERT_TRUE(matched(to, requests, request_reader) && matched(to, jogs, jog_reader) &&
              matched(to, others, jog_reader) && eventually(to, [&] { return jog_reader.matched() == 2; }));
  SampleInfo request, jog, another;
  ASSERT_TRUE(requests.publish({}) && next(to, request_reader, &request));
  ASSERT_TRUE(jogs.publish({}) && next(to, jog_reader, &jog));
  ASSERT_TRUE(others.publish({}) && next(to, jog_reader, &another));
  EXPECT_NE(request.participant, kUnknownParticipant);
  EXPECT_EQ(request.participant, jog.participant);
  EXPECT_NE(request.participant, another.participant);
  EXPECT_NE(request.writer, jog.writer);
}

TEST_P(Samples, ADisposedInstanceKeepsItsKey) {
  auto writer = from.publisher(topics::node);
  auto reader = to.subscriber(topics::node);
  ASSERT_TRUE(matched(to, writer, reader));
  msg::NodeStatus status{};
  status.node = 7;
  ASSERT_TRUE(writer.publish(status));
  ASSERT_TRUE(next(to, reader));
  ASSERT_TRUE(writer.dispose(status));
  SampleInfo info;
  const auto gone = next(to, reader, &info);
  ASSERT_TRUE(gone);
  EXPECT_TRUE(info.disposed);
  EXPECT_FALSE(info.valid);
  EXPECT_EQ(gone->node, 7U);
}

TEST_P(Samples, OfTwoCranesStayApartAndAStarSeesBoth) {
  Bus north{options(GetParam().writer, 42, "north")};
  Bus south{options(GetParam().writer, 42, "south")};
  Bus north_too{options(GetParam().reader, 42, "north")};
  Bus all{options(GetParam().reader, 42, "*")};
  auto north_writer = north.publisher(topics::command);
  auto south_writer = south.publisher(topics::command);
  auto north_reader = north_too.subscriber(topics::command);
  auto all_reader = all.subscriber(topics::command);
  ASSERT_TRUE(eventually(all, [&] {
    return north_writer.matched() >= 2 && south_writer.matched() >= 1 && north_reader.matched() >= 1 &&
           all_reader.matched() >= 2;
  }));
  msg::Command command{};
  command.header.tick = 1;
  ASSERT_TRUE(south_writer.publish(command));
  command.header.tick = 2;
  ASSERT_TRUE(north_writer.publish(command));
  const auto one = next(all, all_reader);
  const auto two = next(all, all_reader);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->header.tick + two->header.tick, 3U);
  const auto own = next(north_too, north_reader);
  ASSERT_TRUE(own);
  EXPECT_EQ(own->header.tick, 2U);
  EXPECT_FALSE(north_reader.take());
  EXPECT_EQ(south_writer.matched(), 1) << "the reader of another crane matched";
}

INSTANTIATE_TEST_SUITE_P(Vendors, Samples, kAllPairs, [](const auto& test) { return name_of(test.param); });

}  // namespace
}  // namespace crane::bus::testing
