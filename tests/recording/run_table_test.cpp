#include "crane/recording/run_table.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "crane/bus/cdr.hpp"
#include "crane/recording/schema.hpp"
#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

using testing::ElementsAre;

msg::State state_of(std::uint64_t tick) {
  msg::State state{};
  state.header.tick = tick;
  state.header.sample_time_ns = 3'000'000'000 + static_cast<std::int64_t>(tick) * 10'000'000;
  state.trolley_position_m = 0.25 + static_cast<double>(tick);
  state.applied_v[0] = 1.5;
  state.applied_v[2] = -2;
  return state;
}

msg::Reference reference_of(std::uint64_t tick) {
  msg::Reference reference{};
  reference.header.tick = tick;
  reference.axis[1].position = 0.7;
  return reference;
}

TEST(RunTable, BeginsWithTheCanonicalColumns) {
  RunTable run;
  run.add(state_of(0));
  const Table table = run.table();
  for (std::size_t i = 0; i < kCanonicalColumns.size(); ++i)
    EXPECT_EQ(table.columns[i].name, kCanonicalColumns[i]);
}

TEST(RunTable, JoinsSamplesOfOneTickWhateverTheirOrder) {
  RunTable run;
  run.add(reference_of(5));
  run.add(state_of(5));
  run.add(state_of(4));
  run.add(reference_of(6));  // no state of tick 6: no row
  msg::SupervisorStatus status{};
  status.header.tick = 4;
  status.state = crane_STATE_RUN;
  run.add(status);
  const Table table = run.table();
  EXPECT_THAT(*table.find("tick"), ElementsAre(4, 5));
  EXPECT_THAT(*table.find("time_s"), ElementsAre(0, 0.01));
  EXPECT_THAT(*table.find("trolley_position_m"), ElementsAre(4.25, 5.25));
  EXPECT_THAT(*table.find("trolley_voltage_v"), ElementsAre(1.5, 1.5));
  EXPECT_THAT(*table.find("hoist_voltage_v"), ElementsAre(-2, -2));
  EXPECT_TRUE(std::isnan((*table.find("slew_reference_rad"))[0]));
  EXPECT_EQ((*table.find("slew_reference_rad"))[1], 0.7);
  EXPECT_EQ((*table.find("supervisor_state"))[0], crane_STATE_RUN);
}

template <class T>
void record(McapWriter& writer, std::uint16_t channel, const topics::Topic<T>& topic, const T& sample) {
  const bus::CdrCodec& codec = bus::CdrCodec::of(*topic.description.descriptor);
  std::vector<std::uint8_t> payload(4 + codec.max_encoded_bytes());
  payload[1] = 1;
  payload.resize(4 + codec.encode(&sample, std::span{payload}.subspan(4)));
  writer.message(channel, static_cast<std::uint32_t>(sample.header.tick), sample.header.sample_time_ns, 0,
                 payload);
}

TEST(RunTable, IsTheSameFromARecordingAsFromTheSamples) {
  const TemporaryDirectory directory;
  RunTable run;
  McapWriter writer{directory / "a.mcap"};
  const TopicChannels channels = add_topic_channels(writer);
  for (std::uint64_t tick = 10; tick < 20; ++tick) {
    msg::SupervisorStatus status{};
    status.header.tick = tick;
    status.state = tick % 2 == 0 ? crane_STATE_FAULT : crane_STATE_BOOT;
    msg::Demand demand{};
    demand.header.tick = tick;
    demand.control_v[1] = 0.1 * static_cast<double>(tick);
    demand.friction_v[0] = -demand.control_v[1];
    run.add(state_of(tick));
    run.add(reference_of(tick));
    run.add(demand);
    run.add(status);
    record(writer, channels[0], topics::state, state_of(tick));
    record(writer, channels[1], topics::reference, reference_of(tick));
    record(writer, channels[4], topics::demand, demand);
    record(writer, channels[6], topics::supervisor, status);
  }
  writer.close();
  McapReader reader{directory / "a.mcap"};
  const Table expected = run.table();
  const Table read = run_table(reader);
  ASSERT_EQ(read.columns.size(), expected.columns.size());
  for (std::size_t i = 0; i < read.columns.size(); ++i) {
    EXPECT_EQ(read.columns[i].name, expected.columns[i].name);
    EXPECT_EQ(read.columns[i].values, expected.columns[i].values) << read.columns[i].name;
  }
}

TEST(RunTable, IsRefusedForMessagesOfAnotherVersionWithBothVersions) {
  const TemporaryDirectory directory;
  for (const char* version : {"1", "2"}) {
    McapWriter writer{directory / version};
    std::string text{topics::idl_text()};
    const std::string own = "MESSAGES_VERSION = " + std::to_string(crane_MESSAGES_VERSION) + ";";
    text.replace(text.find(own), own.size(), std::string{"MESSAGES_VERSION = "} + version + "0;");
    (void)writer.channel(writer.schema("crane::CraneState", "omgidl", text), "crane/state", "cdr");
    writer.close();
    McapReader reader{directory / version};
    EXPECT_EQ(messages_version(reader), std::stoul(version) * 10);
    try {
      (void)run_table(reader);
      ADD_FAILURE() << "read";
    } catch (const SchemaError& error) {
      EXPECT_THAT(error.what(),
                  testing::AllOf(testing::HasSubstr("messages of version " + std::string{version} + "0"),
                                 testing::HasSubstr("this program reads version " +
                                                    std::to_string(crane_MESSAGES_VERSION))));
    }
  }
}

/// A damaged schema may lose the constant: the text must not show a default that equals the own version.
TEST(VersionDifference, ShowsTwoDifferentTexts) {
  for (const std::uint32_t own : {1U, 2U}) {
    EXPECT_EQ(version_difference(own, own), "");
    EXPECT_EQ(version_difference(3, own),
              "messages of version 3, this program reads version " + std::to_string(own));
    EXPECT_EQ(
        version_difference(std::nullopt, own),
        "messages without a version (their schema has no readable MESSAGES_VERSION), this program reads "
        "version " +
            std::to_string(own));
  }
}

TEST(RunTable, ReportsAPayloadThatDoesNotFitItsSchema) {
  const TemporaryDirectory directory;
  McapWriter writer{directory / "a.mcap"};
  const TopicChannels channels = add_topic_channels(writer);
  const std::vector<std::uint8_t> cut{0, 1, 0, 0, 1, 2, 3};
  writer.message(channels[0], 0, 0, 0, cut);
  writer.close();
  McapReader reader{directory / "a.mcap"};
  EXPECT_THROW((void)run_table(reader), DecodeError);
}

TEST(MissingTicks, AreCountedFromTheFirstGap) {
  EXPECT_EQ(missing_ticks({{{"tick", {4, 5, 6}}}}), "");
  EXPECT_EQ(missing_ticks({{{"time_s", {4, 6}}}}), "");
  EXPECT_EQ(missing_ticks({{{"tick", {4, 5, 7}}}}), "1 tick is missing, after tick 5");
  EXPECT_EQ(missing_ticks({{{"tick", {4, 7, 8, 10}}}}), "3 ticks are missing, the first after tick 4");
}

}  // namespace
}  // namespace crane::recording
