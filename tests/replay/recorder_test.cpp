// Recordings of the recorder, in the order of arrival, are replayed up to the first tick that they cannot
// show.
#include <gtest/gtest.h>

#include <cstring>

#include "recorded_crane.hpp"
#include "recorder/recorder.hpp"
#include "replay/replay.hpp"
#include "replay/swap.hpp"

namespace crane::replay_test {
namespace {

using replay::Result;
using testing::Test;

bus::Options recorder_options(const std::shared_ptr<bus::MemoryNetwork>& network) {
  auto options = runtime::memory_options(network, "recorder", crane_SOURCE_RECORDER);
  options.epoch = 77;
  return options;
}

/// An armed crane that moves and stops, recorded by the recorder.
class ByTheRecorder : public Test {
 protected:
  void SetUp() override {
    RecordedCrane crane{directory_ / "in_order.mcap", "virginia_tech_tower", "gain_scheduling_partial"};
    std::unique_ptr<recorder::Recorder> recorder;
    bus::Bus bus{recorder_options(crane.observed_by([&] { ASSERT_TRUE(recorder->poll()); }))};
    recorder = std::make_unique<recorder::Recorder>(
        bus, recorder::Options{.file = file_, .rig_text = crane.rig_text()});
    crane.arm();
    crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, true, false}, .target = {0.8, 0.4, 0}});
    crane.run(1);
    crane.ask(crane_REQUEST_STOP);
    crane.run_until(crane_STATE_LOCKED, 10);
    ticks_ = crane.finish();
    ASSERT_TRUE(recorder->close());
  }
  static Result replayed(const std::filesystem::path& file) {
    return replay::replay(file, replay::loop_components());
  }
  /// A copy without the samples that `omit` selects.
  std::filesystem::path without(const std::function<bool(const recording::Message&)>& omit) {
    auto copy = directory_ / "copy.mcap";
    copy_changed(file_, copy, [&](const recording::Message& message, std::vector<std::uint8_t>&) {
      return message.channel->topic == recording::kLossTopic || !omit(message);
    });
    return copy;
  }
  std::filesystem::path without(const topics::Description& topic, std::uint32_t tick) {
    return without([&topic, tick](const recording::Message& message) {
      return message.channel->topic == topic.name && message.sequence == tick;
    });
  }

  recording::TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "recorder.mcap";
  std::uint64_t ticks_ = 0;
};

TEST_F(ByTheRecorder, IsReplayedBitForBit) {
  const auto result = replayed(file_);
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.equal_ticks, ticks_);
  EXPECT_TRUE(result.by_recorder);
  EXPECT_EQ(result.ends, "");
  EXPECT_EQ(result.not_recorded, 0U);
}

/// The programs of the operator ended before the recorder discovered them.
TEST_F(ByTheRecorder, IsReplayedWithoutASampleOfTheOperator) {
  const auto result = replayed(without([](const recording::Message& message) {
    return message.channel->topic == topics::request.description.name;
  }));
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.equal_ticks, ticks_);
}

TEST_F(ByTheRecorder, TheAcceptedRequestsAreTheRequestsOfTheOperator) {
  std::vector<msg::Request> sent;
  std::vector<msg::AcceptedRequest> accepted;
  recording::McapReader reader{file_};
  reader.for_each({}, [&](const recording::Message& message) {
    if (message.channel->topic == topics::request.description.name)
      sent.push_back(*replay::decoded(topics::request, message.data));
    if (message.channel->topic == topics::accepted_request.description.name)
      accepted.push_back(*replay::decoded(topics::accepted_request, message.data));
    return true;
  });
  std::erase_if(sent, [](const auto& request) { return request.kind == crane_REQUEST_ADVANCE; });
  ASSERT_EQ(sent.size(), 4U);
  ASSERT_EQ(accepted.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i)
    EXPECT_EQ(replay::encoded(topics::request.description, &accepted[i].request),
              replay::encoded(topics::request.description, &sent[i]));
}

TEST_F(ByTheRecorder, ARequestIsTakenFromTheAcceptedRequests) {
  const auto copy = directory_ / "other_target.mcap";
  std::uint64_t tick = 0;
  copy_changed(file_, copy, [&](const recording::Message& message, std::vector<std::uint8_t>& data) {
    if (message.channel->topic != topics::accepted_request.description.name)
      return message.channel->topic != recording::kLossTopic;
    auto accepted = *replay::decoded(topics::accepted_request, data);
    if (accepted.request.kind != crane_REQUEST_MOVE) return true;
    tick = accepted.header.tick;
    accepted.request.target[1] = 0.5;
    data = replay::published(topics::accepted_request, accepted);
    return true;
  });
  const auto result = replayed(copy);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.first->tick, tick);
  EXPECT_EQ(result.first->topic, "crane/supervisor");
  EXPECT_EQ(result.first->what.field, "move.target[1]");
}

TEST_F(ByTheRecorder, ASampleThatIsNotRecordedIsNotCompared) {
  const auto result = replayed(without(topics::demand.description, 300));
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.equal_ticks, ticks_);
  EXPECT_EQ(result.not_recorded, 1U);
}

TEST_F(ByTheRecorder, TheReplayEndsBeforeATickWithoutState) {
  const auto result = replayed(without(topics::state.description, 300));
  EXPECT_FALSE(result.first);
  EXPECT_EQ(result.equal_ticks, 300U);
  EXPECT_EQ(result.ends, "tick 300: no crane/state: the recorder did not receive the sample");
}

TEST_F(ByTheRecorder, TheReplayEndsAfterTicksThatTheRecorderMissed) {
  const auto result = replayed(without(
      [](const recording::Message& message) { return message.sequence >= 300 && message.sequence < 306; }));
  EXPECT_FALSE(result.first);
  EXPECT_EQ(result.ends, "tick 306: the recorder did not receive the samples of the tick before");
}

TEST_F(ByTheRecorder, TheReplayEndsWhereAProcessIsRestarted) {
  const auto copy = directory_ / "restarted.mcap";
  copy_changed(file_, copy, [](const recording::Message& message, std::vector<std::uint8_t>& data) {
    if (message.channel->topic == topics::tracking.description.name && message.sequence == 250)
      data = replay::with_epoch(topics::tracking.description, data, 99);
    return message.channel->topic != recording::kLossTopic;
  });
  const auto result = replayed(copy);
  EXPECT_EQ(result.equal_ticks, 250U);
  EXPECT_EQ(result.ends, "tick 250: crane/tracking has another start-up number: its process was restarted");
}

/// The status of the supervisor shows that the demand was published.
TEST_F(ByTheRecorder, ASampleThatTheRecorderMissedExplainsNoDifference) {
  const auto copy = directory_ / "missed.mcap";
  copy_changed(file_, copy, [](const recording::Message& message, std::vector<std::uint8_t>& data) {
    const auto& topic = message.channel->topic;
    if (topic == topics::command.description.name && message.sequence == 280)
      data[bus::kEncapsulation_bytes + sizeof(msg::Header)] ^= 1U;  // lowest bit of drive_v[0]
    return topic != recording::kLossTopic &&
           (topic != topics::demand.description.name || message.sequence != 279);
  });
  const auto result = replayed(copy);
  EXPECT_EQ(result.equal_ticks, 280U);
  EXPECT_EQ(result.not_recorded, 1U);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.first->topic, "crane/command");
}

/// Later samples presuppose them.
TEST_F(ByTheRecorder, SamplesOfOneProcessThatTheRecorderMissedAreInferred) {
  for (const auto* topic : {&topics::reference.description, &topics::tracking.description,
                            &topics::anti_swing.description, &topics::command.description}) {
    const auto result = replayed(without([topic](const recording::Message& message) {
      return message.channel->topic == topic->name && message.sequence > 290 && message.sequence < 310;
    }));
    EXPECT_FALSE(result.first) << replay::sentence(*result.first);
    EXPECT_EQ(result.equal_ticks, ticks_) << topic->name << ": " << result.ends;
    EXPECT_EQ(result.not_recorded, 19U) << topic->name;
  }
}

TEST_F(ByTheRecorder, AnotherDemandIsNamedWithTickAndField) {
  const auto copy = directory_ / "changed.mcap";
  copy_changed(file_, copy, [](const recording::Message& message, std::vector<std::uint8_t>& data) {
    if (message.channel->topic == topics::demand.description.name && message.sequence == 280)
      data[bus::kEncapsulation_bytes + sizeof(msg::Header)] ^= 1U;  // lowest bit of control_v[0]
    return message.channel->topic != recording::kLossTopic;
  });
  const auto result = replayed(copy);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.equal_ticks, 280U);
  EXPECT_EQ(result.first->topic, "crane/demand");
  EXPECT_EQ(result.first->what.field, "control_v[0]");
}

/// The recorder discovers the bridge after its first ticks.
TEST_F(ByTheRecorder, TheCraneRestsBeforeTheFirstRecordedTickOfAStart) {
  const auto result = replayed(without([](const recording::Message& message) {
    return message.sequence < 5 && message.channel->topic != topics::node.description.name;
  }));
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.equal_ticks, ticks_);
  EXPECT_EQ(result.assumed_ticks, 5U);
}

/// The bridge has published states before the other processes discovered it.
TEST_F(ByTheRecorder, StatesBeforeTheFirstStepOfTheStackAreNotReplayed) {
  const auto copy = directory_ / "early.mcap";
  recording::McapReader reader{file_};
  recording::McapWriter writer{copy};
  const auto channels = recording::add_topic_channels(writer);
  for (const auto& record : reader.metadata()) writer.metadata(record.name, record.entries);
  for (const auto& each : reader.attachments())
    writer.attachment(each.name, each.media_type, each.time_ns, each.data);
  // Every tick, and every reply, gets a number that is higher by 3; three states precede them.
  constexpr std::uint64_t kEarlier = 3;
  reader.for_each({}, [&](const recording::Message& message) {
    const auto* topic = replay::topic_named(message.channel->topic);
    if (topic == nullptr) return true;
    const auto write = [&](std::uint64_t earlier) {
      const auto& codec = bus::CdrCodec::of(*topic->descriptor);
      std::vector<std::uint8_t> sample(codec.sample_bytes());
      EXPECT_TRUE(codec.decode(message.data.subspan(bus::kEncapsulation_bytes), false, sample.data()));
      msg::Header header{};
      std::memcpy(&header, sample.data(), sizeof header);
      header.tick += kEarlier - earlier;
      std::memcpy(sample.data(), &header, sizeof header);
      bus::seal(*topic, sample.data(), header.source, header.epoch);
      writer.message(channels[message.channel->id], static_cast<std::uint32_t>(header.tick),
                     message.log_time_ns, message.publish_time_ns, replay::encoded(*topic, sample.data()));
    };
    if (topic->name == topics::state.description.name && message.sequence == 0)
      for (auto earlier = kEarlier; earlier > 0; --earlier) write(earlier);
    write(0);
    return true;
  });
  writer.close();
  const auto result = replayed(copy);
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.equal_ticks, ticks_);
  EXPECT_EQ(result.assumed_ticks, 0U);
}

TEST_F(ByTheRecorder, IsRefusedWhenItBeginsLater) {
  const auto copy = without([](const recording::Message& message) {
    return message.sequence < 20 && message.channel->topic != topics::node.description.name;
  });
  try {
    (void)replayed(copy);
    FAIL();
  } catch (const replay::Refusal& refusal) {
    EXPECT_NE(std::string{refusal.what()}.find("begins with tick 20; a replay needs tick 0"),
              std::string::npos)
        << refusal.what();
  }
}

TEST_F(ByTheRecorder, ShowsTheDemandOfAnotherController) {
  const auto result = replay::swap_controller(file_, "delayed_1");
  EXPECT_EQ(result.ticks, ticks_);
  EXPECT_EQ(result.recorded, "gain_scheduling_partial");
  ASSERT_TRUE(result.first_differs);
  EXPECT_GT(result.largest[0].difference_v, 0.1);
}

}  // namespace
}  // namespace crane::replay_test
