#include "crane/recording/mcap_reader.hpp"

#include <gmock/gmock.h>

#include <random>

#include "sample_recording.hpp"
#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(McapReader, ReadsBackEverythingThatWasWritten) {
  const TemporaryDirectory directory;
  write_sample(directory / "a.mcap", 1000);
  McapReader reader{directory / "a.mcap"};
  EXPECT_TRUE(reader.indexed());
  EXPECT_EQ(reader.first_time_ns(), kStart_ns);
  EXPECT_EQ(reader.last_time_ns(), kStart_ns + 999 * kTick_ns);
  bool genuine = false;
  EXPECT_EQ(sequences_in(reader, &genuine), first_numbers(1000));
  EXPECT_TRUE(genuine);
  ASSERT_EQ(reader.channels().size(), 2U);
  EXPECT_EQ(reader.channels()[0].metadata.at("unit"), "SI");
  ASSERT_EQ(reader.metadata().size(), 1U);
  EXPECT_EQ(reader.metadata()[0].entries.at("rig"), "virginia_tech_tower");
  ASSERT_EQ(reader.attachments().size(), 1U);
  EXPECT_EQ(reader.attachments()[0].name, "rig.toml");
  EXPECT_EQ(reader.attachments()[0].data.size(), 16U);
  EXPECT_THAT(reader.problems(), IsEmpty());
}

TEST(McapReader, ReturnsOnlyTheSelectedTopicsAndTimes) {
  const TemporaryDirectory directory;
  write_sample(directory / "a.mcap", 1000);
  McapReader reader{directory / "a.mcap"};
  Selection selection{{"crane/state"}, kStart_ns + 399 * kTick_ns, kStart_ns + 404 * kTick_ns};
  bool genuine = false;
  EXPECT_THAT(sequences_in(reader, &genuine, selection), ElementsAre(400, 402, 404));
}

TEST(McapReader, StopsWhenTheVisitorReturnsFalse) {
  const TemporaryDirectory directory;
  write_sample(directory / "a.mcap", 300);
  McapReader reader{directory / "a.mcap"};
  int count = 0;
  reader.for_each({}, [&](const Message&) { return ++count < 5; });
  EXPECT_EQ(count, 5);
}

TEST(McapReader, PutsMessagesWrittenOutOfOrderIntoTheOrderOfTheirTimes) {
  const TemporaryDirectory directory;
  constexpr std::uint32_t kReaderSeed = 7;
  std::mt19937 random{kReaderSeed};
  std::vector<std::uint32_t> order = first_numbers(2000);
  for (std::size_t i = 0; i + 300 < order.size(); i += 150)  // late by up to 3 s: chunks overlap
    std::shuffle(order.begin() + static_cast<std::ptrdiff_t>(i),
                 order.begin() + static_cast<std::ptrdiff_t>(i + 300), random);
  McapWriter writer{directory / "a.mcap", {.chunk_bytes = 3000}};
  const std::uint16_t state = writer.channel(0, "crane/state", "cdr");
  const std::uint16_t note = writer.channel(0, "crane/note", "json");
  for (const std::uint32_t i : order)
    writer.message(i % 2 == 0 ? state : note, i, kStart_ns + kTick_ns * i, kStart_ns + kTick_ns * i + 7,
                   payload_of(i));
  writer.close();
  McapReader reader{directory / "a.mcap"};
  bool genuine = false;
  EXPECT_EQ(sequences_in(reader, &genuine), first_numbers(2000)) << "seed " << kReaderSeed;
  EXPECT_TRUE(genuine);
}

TEST(McapReader, KeepsTheFileOrderOfEqualTimes) {
  const TemporaryDirectory directory;
  McapWriter writer{directory / "a.mcap", {.chunk_bytes = 500}};
  const std::uint16_t channel = writer.channel(0, "crane/state", "cdr");
  for (std::uint32_t i = 0; i < 100; ++i) writer.message(channel, i, 42, 42, payload_of(i));
  writer.close();
  McapReader reader{directory / "a.mcap"};
  std::vector<std::uint32_t> sequences;
  reader.for_each({}, [&](const Message& message) {
    sequences.push_back(message.sequence);
    return true;
  });
  EXPECT_EQ(sequences, first_numbers(100));
}

TEST(McapReader, ReadsARecordingWithoutMessages) {
  const TemporaryDirectory directory;
  McapWriter{directory / "a.mcap"}.close();
  EXPECT_EQ(check(directory / "a.mcap").messages, 0U);
  EXPECT_THAT(check(directory / "a.mcap").problems, IsEmpty());
}

std::string error_of(const std::filesystem::path& file) {
  try {
    const McapReader reader{file};
  } catch (const ReadError& error) {
    return error.what();
  }
  return "no ReadError";
}

TEST(McapReader, NamesTheReasonWhenAFileIsNotARecording) {
  const TemporaryDirectory directory;
  put_contents(directory / "empty.mcap", "");
  put_contents(directory / "text.mcap", "time_s,trolley_position_m\n0,0.25\n");
  put_contents(directory / "short.mcap", std::string("\x89MCA", 4));
  EXPECT_EQ(error_of("/nowhere/a.mcap"), "/nowhere/a.mcap: cannot open: No such file or directory");
  EXPECT_THAT(error_of(directory / "empty.mcap"), HasSubstr("empty.mcap: is empty"));
  EXPECT_THAT(error_of(directory / "text.mcap"), HasSubstr("text.mcap: is not an MCAP recording"));
  EXPECT_THAT(error_of(directory / "short.mcap"), HasSubstr("short.mcap: is not an MCAP recording"));
  EXPECT_THAT(error_of(directory / "."), HasSubstr("is not a regular file"));
}

}  // namespace
}  // namespace crane::recording
