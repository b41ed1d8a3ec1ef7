// Losses of the recorder in a recording.
#include "crane/recording/loss.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "crane/recording/mcap_edit.hpp"
#include "crane/recording/run_table.hpp"
#include "crane/recording/schema.hpp"
#include "sample_recording.hpp"
#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

constexpr std::array kCauses{LossCause::queue_full, LossCause::dds_lost, LossCause::wrong_crc,
                             LossCause::file_removed};

void write_losses(const std::filesystem::path& file) {
  McapWriter writer{file};
  const auto channel = add_loss_channel(writer);
  // texts of lengths 0 to 3 modulo 4, and thereby all paddings
  for (std::size_t i = 0; i < kCauses.size(); ++i)
    write_loss(writer, channel,
               {.topic = "crane/" + std::string(i, 'x'),
                .cause = kCauses.at(i),
                .samples = 10 + i,
                .from_ns = kStart_ns + static_cast<std::int64_t>(i),
                .until_ns = kStart_ns + kTick_ns * static_cast<std::int64_t>(i)});
  writer.close();
}

void expect_losses(const std::filesystem::path& file) {
  McapReader reader{file};
  const auto losses = losses_in(reader);
  ASSERT_EQ(losses.size(), kCauses.size());
  for (std::size_t i = 0; i < losses.size(); ++i) {
    EXPECT_EQ(losses[i].topic, "crane/" + std::string(i, 'x'));
    EXPECT_EQ(losses[i].cause, kCauses.at(i));
    EXPECT_EQ(losses[i].samples, 10 + i);
    EXPECT_EQ(losses[i].from_ns, kStart_ns + static_cast<std::int64_t>(i));
    EXPECT_EQ(losses[i].until_ns, kStart_ns + kTick_ns * static_cast<std::int64_t>(i));
  }
}

TEST(Losses, AreReadAsTheyWereWritten) {
  const TemporaryDirectory directory;
  write_losses(directory / "a.mcap");
  expect_losses(directory / "a.mcap");
}

TEST(Losses, StayInARepairedAndAMergedRecording) {
  const TemporaryDirectory directory;
  write_losses(directory / "a.mcap");
  (void)repair(directory / "a.mcap", directory / "b.mcap");
  write_sample(directory / "c.mcap", 10);
  (void)merge(std::array{directory / "b.mcap", directory / "c.mcap"}, directory / "d.mcap");
  expect_losses(directory / "d.mcap");
}

TEST(Losses, AreDecodedWithTheSchemaOfTheRecording) {
  const TemporaryDirectory directory;
  write_losses(directory / "a.mcap");
  McapReader reader{directory / "a.mcap"};
  const auto* schema = reader.find_schema(reader.channels().front().schema_id);
  reader.for_each({}, [&](const Message& message) {
    EXPECT_EQ(Schema{schema->text}.decode(schema->name, message.data).at("cause"), "QUEUE_FULL");
    return false;
  });
}

TEST(Losses, OfARecordingWithoutTheChannelAreUnknown) {
  const TemporaryDirectory directory;
  write_sample(directory / "a.mcap", 10);
  McapReader without{directory / "a.mcap"};
  EXPECT_FALSE(has_losses_channel(without));
  EXPECT_TRUE(losses_in(without).empty());
  write_losses(directory / "b.mcap");
  EXPECT_TRUE(has_losses_channel(McapReader{directory / "b.mcap"}));
}

TEST(Losses, DoNotHideTheVersionOfTheMessages) {
  const TemporaryDirectory directory;
  {
    McapWriter writer{directory / "a.mcap"};
    add_loss_channel(writer);
    add_topic_channels(writer);
    writer.close();
  }
  EXPECT_EQ(messages_version(McapReader{directory / "a.mcap"}), crane_MESSAGES_VERSION);
}

}  // namespace
}  // namespace crane::recording
