/// Tools that listen to a running crane, over the memory bus: recorder, snapshot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "cli/log_export.hpp"
#include "cli/sample_json.hpp"
#include "cli/snapshot.hpp"
#include "crane/recording/loss.hpp"
#include "crane/runtime/process.hpp"
#include "memory_bus.hpp"
#include "recorder/recorder.hpp"
#include "temporary_directory.hpp"

namespace crane::cli {
namespace {

using recording::TemporaryDirectory;
using testing::HasSubstr;

class Observers : public testing::Test {
 protected:
  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();
  bus::Bus crane_ = bus_on(network_, crane_SOURCE_SUPERVISOR);
  bus::Bus tool_ = bus_on(network_, crane_SOURCE_RECORDER);
};

TEST_F(Observers, RecorderWritesWhatWasPublishedWithTheTickAsSequence) {
  const TemporaryDirectory directory;
  const auto file = directory / "run.mcap";
  auto states = crane_.publisher(topics::state);
  recorder::Recorder recorder{tool_, {.file = file, .topics = {&topics::kAll.front()}}};
  EXPECT_FALSE(recorder.heard_others());
  for (std::uint64_t tick = 1; tick <= 50; ++tick) {
    msg::State state{};
    state.header.tick = tick;
    state.trolley_position_m = 0.01 * static_cast<double>(tick);
    EXPECT_TRUE(states.publish(state));
    ASSERT_TRUE(recorder.poll());
  }
  ASSERT_TRUE(recorder.close());
  EXPECT_TRUE(recorder.heard_others());

  recording::McapReader reader{file};
  std::uint32_t tick = 0;
  std::int64_t newest_ns = 0;
  reader.for_each({}, [&](const recording::Message& message) {
    EXPECT_EQ(message.sequence, ++tick);
    EXPECT_GE(message.log_time_ns, newest_ns);
    newest_ns = message.log_time_ns;
    const auto decoded = schema().decode("crane::CraneState", message.data);
    EXPECT_EQ(decoded.at("trolley_position_m"), 0.01 * tick);
    return true;
  });
  EXPECT_EQ(tick, 50U);
  EXPECT_TRUE(recording::check(file).problems.empty());
}

TEST_F(Observers, RecorderStatesHowManyTicksOfAWriterHaveNoSample) {
  const TemporaryDirectory directory;
  const auto file = directory / "run.mcap";
  auto options = options_on(network_, crane_SOURCE_SUPERVISOR);
  options.epoch = 2;
  bus::Bus restarted{options};
  auto demands = crane_.publisher(topics::demand), later = restarted.publisher(topics::demand);
  recorder::Recorder recorder{tool_, {.file = file}};
  const auto publish = [&](auto& publisher, std::uint64_t tick) {
    msg::Demand demand{};
    demand.header.tick = tick;
    EXPECT_TRUE(publisher.publish(demand));
    EXPECT_TRUE(recorder.poll());
  };
  for (const std::uint64_t tick : {100, 101, 105, 106, 109}) publish(demands, tick);
  for (const std::uint64_t tick : {1, 2, 4}) publish(later, tick);
  ASSERT_TRUE(recorder.close());
  recording::McapReader reader{file};
  std::uint64_t missing = 0;
  for (const auto& loss : recording::losses_in(reader)) {
    EXPECT_EQ(loss.topic, "crane/demand");
    EXPECT_EQ(loss.cause, recording::LossCause::tick_gap);
    missing += loss.samples;
  }
  EXPECT_EQ(missing, 3U + 2U + 1U) << "a restarted writer begins without a gap";
}

TEST_F(Observers, ExportQuotesTextAndKeepsNumbersAsTheyAre) {
  const TemporaryDirectory directory;
  const auto file = directory / "run.mcap";
  auto replies = crane_.publisher(topics::reply);
  recorder::Recorder recorder{tool_, {.file = file}};
  msg::Reply reply{};
  reply.request_id = 18'446'744'073'709'551'615U;
  reply.accepted = true;
  runtime::assign(reply.reason, "say \"no\", then stop");
  EXPECT_TRUE(replies.publish(reply));
  recorder.poll();
  recorder.close();

  recording::McapReader reader{file};
  std::ostringstream csv, json;
  write_topic_csv(csv, reader, "reply");
  EXPECT_THAT(csv.str(), HasSubstr("log_time_ns,publish_time_ns,header.tick"));
  EXPECT_THAT(csv.str(), HasSubstr(",18446744073709551615,,1,\"say \"\"no\"\", then stop\","));
  write_json_lines(json, reader, "crane/reply");
  EXPECT_EQ(nlohmann::json::parse(json.str()).at("data").at("request_id"), 18'446'744'073'709'551'615U);
  EXPECT_EQ(describe(reader, file).at("metadata").at(0).at("entries").at("crane"), "crane");
  EXPECT_THROW(write_topic_csv(csv, reader, "nothing"), std::runtime_error);
}

TEST_F(Observers, SnapshotNamesTheCauseAndItsRemedy) {
  auto states = crane_.publisher(topics::state);
  auto statuses = crane_.publisher(topics::supervisor);
  runtime::Node node{crane_, {"supervisor", ""}};
  std::atomic<bool> done = false;
  std::thread stack{[&] {
    while (!done) {
      msg::State state{};
      state.brake_closed[0] = true;
      state.position_known[1] = state.position_known[2] = true;
      state.latch_reason = crane_LATCH_LOST_COUNTS;
      EXPECT_TRUE(states.publish(state));
      msg::SupervisorStatus status{};
      status.state = crane_STATE_LOCKED;
      status.cause = crane_CAUSE_SWING_LIMIT;
      EXPECT_TRUE(statuses.publish(status));
      node.beat(runtime::monotonic_ns(), crane_PHASE_READY, {}, 0);
      crane_.wait(std::chrono::milliseconds{1});
    }
  }};
  const auto snapshot = listen(tool_, 10);
  done = true;
  stack.join();
  std::ostringstream text;
  print(text, snapshot);
  EXPECT_THAT(text.str(), HasSubstr("LOCKED because of SWING_LIMIT: "));
  EXPECT_THAT(text.str(), HasSubstr("stopped the crane: lost_counts"));
  EXPECT_THAT(text.str(), HasSubstr("closed, not homed\n"));
  EXPECT_THAT(text.str(), HasSubstr("open\n"));
  const auto json = to_json(snapshot);
  EXPECT_EQ(json.at("supervisor").at("state"), "STATE_LOCKED");
  EXPECT_NE(json.at("supervisor").at("remedy"), "");
  EXPECT_EQ(json.at("nodes").at(0).at("name"), "supervisor");
  EXPECT_EQ(json.at("state").at("brake_closed").at(0), true);
}

TEST_F(Observers, SnapshotWithoutACraneIsEmpty) { EXPECT_TRUE(listen(tool_, 0.01).empty()); }

TEST(SampleJson, FieldSelectsALeafOrAllLeavesBelowIt) {
  const msg::Reference reference{};
  const auto sample = to_json(topics::reference, reference);
  EXPECT_EQ(leaves_below(sample, "axis[1]").size(), 3U);
  EXPECT_EQ(leaves_below(sample, "axis").size(), 9U);
  EXPECT_EQ(leaves_below(sample, "header.tick").size(), 1U);
  EXPECT_TRUE(leaves_below(sample, "head").empty());
  EXPECT_EQ(find_topic("state"), find_topic("crane/state"));
  EXPECT_EQ(find_topic("rane/state"), nullptr);
}

}  // namespace
}  // namespace crane::cli
