// Cut and corrupted recordings: all intact data are read, no wrong data are returned, and every loss is
// reported.
#include <gmock/gmock.h>

#include <random>

#include "sample_recording.hpp"
#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::uint32_t kSeed = 20240601;

/// A recording of chunks of known length: `ends[k]` is the size of the file after chunk k.
struct Chunked {
  std::string bytes;
  std::vector<std::size_t> ends;
  std::uint32_t per_chunk = 20;
};

Chunked chunked_recording(const TemporaryDirectory& directory) {
  const std::filesystem::path file = directory / "whole.mcap";
  Chunked result;
  {
    McapWriter writer{file};
    const std::uint16_t state = writer.channel(0, "crane/state", "cdr");
    const std::uint16_t note = writer.channel(0, "crane/note", "json");
    for (std::uint32_t i = 0; i < 10 * result.per_chunk; ++i) {
      const std::int64_t time_ns = kStart_ns + kTick_ns * i;
      writer.message(i % 2 == 0 ? state : note, i, time_ns, time_ns + 7, payload_of(i));
      if ((i + 1) % result.per_chunk != 0) continue;
      writer.flush();
      result.ends.push_back(writer.bytes_written());
    }
    writer.close();
  }
  result.bytes = contents_of(file);
  return result;
}

/// Messages that must be readable in the first `size` bytes.
std::size_t messages_before(const Chunked& recording, std::size_t size) {
  const auto whole =
      std::upper_bound(recording.ends.begin(), recording.ends.end(), size) - recording.ends.begin();
  return static_cast<std::size_t>(whole) * recording.per_chunk;
}

void expect_readable(const std::filesystem::path& file, const Chunked& recording, std::size_t size) {
  put_contents(file, recording.bytes.substr(0, size));
  McapReader reader{file};
  bool genuine = false;
  const auto sequences = sequences_in(reader, &genuine);
  EXPECT_TRUE(genuine) << "cut at " << size;
  EXPECT_GE(sequences.size(), messages_before(recording, size)) << "cut at " << size;
  EXPECT_EQ(sequences, first_numbers(sequences.size())) << "cut at " << size;
  EXPECT_FALSE(reader.indexed()) << "cut at " << size;
  EXPECT_THAT(reader.problems(), Not(IsEmpty())) << "cut at " << size;
}

TEST(CutRecording, GivesEveryChunkBeforeTheCutAtAndAroundEveryChunkBoundary) {
  const TemporaryDirectory directory;
  const Chunked recording = chunked_recording(directory);
  for (const std::size_t end : recording.ends)
    for (const std::size_t size : {end - 1, end, end + 1, end + 9, end + 20})
      expect_readable(directory / "cut.mcap", recording, size);
}

TEST(CutRecording, GivesEveryChunkBeforeRandomCuts) {
  const TemporaryDirectory directory;
  const Chunked recording = chunked_recording(directory);
  std::mt19937 random{kSeed};
  std::uniform_int_distribution<std::size_t> anywhere{8, recording.bytes.size() - 1};
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  for (int i = 0; i < 300; ++i) expect_readable(directory / "cut.mcap", recording, anywhere(random));
}

TEST(CutRecording, StatesTheNumberOfLostBytes) {
  const TemporaryDirectory directory;
  const Chunked recording = chunked_recording(directory);
  put_contents(directory / "cut.mcap", recording.bytes.substr(0, recording.ends[3] + 100));
  EXPECT_THAT(
      check(directory / "cut.mcap").problems,
      testing::ElementsAre(HasSubstr("cut.mcap: has no usable index"),
                           HasSubstr("byte " + std::to_string(recording.ends[3]) +
                                     ": the file ends inside a record: its last 100 bytes are lost")));
}

/// Reads the file with a changed byte `at`: only correct messages, and either all of them or a problem.
void expect_honest(const std::filesystem::path& file, std::string bytes, std::size_t at, std::size_t count) {
  bytes[at] = static_cast<char>(bytes[at] ^ 0x41);
  put_contents(file, bytes);
  McapReader reader{file};
  bool genuine = false;
  const auto sequences = sequences_in(reader, &genuine);
  EXPECT_TRUE(genuine) << "byte " << at;
  EXPECT_TRUE(std::is_sorted(sequences.begin(), sequences.end())) << "byte " << at;
  EXPECT_TRUE(sequences.size() == count || !reader.problems().empty()) << "byte " << at;
  EXPECT_GE(sequences.size() + 20, count) << "byte " << at << ": more than the damaged chunk is lost";
}

TEST(CorruptedRecording, NeverGivesAWrongMessageAndReportsEachLoss) {
  const TemporaryDirectory directory;
  const Chunked recording = chunked_recording(directory);
  // Begins at the second chunk, because the first chunk declares the channels (next test).
  for (std::size_t at = recording.ends[0]; at < recording.bytes.size(); at += 41)
    expect_honest(directory / "bad.mcap", recording.bytes, at, 200);
}

TEST(HostileRecording, WithAChunkThatUnpacksToAMultipleOfItsSizeIsReadWithoutThisChunk) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory / "bomb.mcap";
  constexpr std::size_t kTooLarge = (1U << 26U) + 1;
  {
    McapWriter writer{file, {.chunk_bytes = 1U << 30U}};
    const std::uint16_t state = writer.channel(0, "crane/state", "cdr");
    writer.message(state, 0, kStart_ns, kStart_ns, std::vector<std::uint8_t>(kTooLarge));
    writer.close();
  }
  ASSERT_LT(std::filesystem::file_size(file), 20'000U);
  McapReader reader{file};
  EXPECT_EQ(reader.messages({}).next(), nullptr);
  EXPECT_THAT(reader.problems(), testing::ElementsAre(HasSubstr("is above 64 MiB")));
}

TEST(HostileRecording, WhoseIndexNamesAChunkTwiceIsReadWithoutItsIndex) {
  const TemporaryDirectory directory;
  const Chunked recording = chunked_recording(directory);
  std::string bytes = recording.bytes;
  // opcode 8 and offsets of chunks 1 and 2 in their index records
  const auto place_of = [](std::uint64_t offset) {
    return std::string{reinterpret_cast<const char*>(&offset), sizeof offset};
  };
  constexpr std::size_t kMagic_bytes = 8, kCrc_bytes = 4;
  const auto second = bytes.rfind(place_of(recording.ends[0]));
  ASSERT_NE(second, std::string::npos);
  const auto third = bytes.rfind(place_of(recording.ends[1]));
  ASSERT_NE(third, std::string::npos);
  bytes.replace(third, sizeof(std::uint64_t), place_of(recording.ends[0]));
  bytes.replace(bytes.size() - kMagic_bytes - kCrc_bytes, kCrc_bytes, kCrc_bytes, '\0');  // 0: no CRC
  put_contents(directory / "twice.mcap", bytes);
  McapReader reader{directory / "twice.mcap"};
  EXPECT_FALSE(reader.indexed());
  bool genuine = false;
  EXPECT_EQ(sequences_in(reader, &genuine), first_numbers(200));
  EXPECT_TRUE(genuine);
}

TEST(HostileRecording, WhoseIndexNamesAMetadataRecordTwiceIsReadWithoutItsIndex) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory / "twice.mcap";
  {
    McapWriter writer{file};
    writer.metadata("first", {{"number", "1"}});
    writer.metadata("other", {{"number", "2"}});
    writer.close();
  }
  std::string bytes = contents_of(file);
  constexpr std::size_t kHead_bytes = 1 + 8 + 4;  // opcode, length of the record, length of its name
  const auto place_of = [&](const char* name) {
    const std::uint64_t offset = bytes.find(name) - kHead_bytes;
    return std::string{reinterpret_cast<const char*>(&offset), sizeof offset};
  };
  const auto index = bytes.rfind(place_of("other"));
  ASSERT_NE(index, std::string::npos);
  bytes.replace(index, sizeof(std::uint64_t), place_of("first"));
  constexpr std::size_t kMagic_bytes = 8, kCrc_bytes = 4;
  bytes.replace(bytes.size() - kMagic_bytes - kCrc_bytes, kCrc_bytes, kCrc_bytes, '\0');  // 0: no CRC
  put_contents(file, bytes);
  McapReader reader{file};
  EXPECT_FALSE(reader.indexed());
  const auto metadata = reader.metadata();
  ASSERT_EQ(metadata.size(), 2U);
  EXPECT_EQ(metadata[1].entries.at("number"), "2");
}

TEST(CorruptedRecording, ReportsTheCrcOfTheDamagedChunkAndReadsTheOthers) {
  const TemporaryDirectory directory;
  const Chunked recording = chunked_recording(directory);
  std::string bytes = recording.bytes;
  const std::size_t crc_at = recording.ends[4] + 9 + 24;  // stored CRC of chunk 5
  bytes[crc_at] = static_cast<char>(bytes[crc_at] ^ 1);
  put_contents(directory / "bad.mcap", bytes);
  const CheckReport report = check(directory / "bad.mcap");
  EXPECT_EQ(report.messages, 180U);
  EXPECT_THAT(report.problems,
              testing::ElementsAre(HasSubstr("byte " + std::to_string(recording.ends[4]) +
                                             ": chunk is damaged and skipped: CRC is wrong")));
}

TEST(CorruptedRecording, IsSkippedToTheNextChunkAlsoWithoutAnIndex) {
  const TemporaryDirectory directory;
  const Chunked recording = chunked_recording(directory);
  std::string bytes = recording.bytes.substr(0, recording.ends[8]);
  for (std::size_t i = 0; i < 60; ++i) bytes[recording.ends[2] + i] = '\xEE';
  put_contents(directory / "bad.mcap", bytes);
  McapReader reader{directory / "bad.mcap"};
  bool genuine = false;
  EXPECT_EQ(sequences_in(reader, &genuine).size(), 160U);
  EXPECT_TRUE(genuine);
  EXPECT_THAT(reader.problems(), testing::Contains(HasSubstr("bytes are damaged and skipped")));
}

TEST(CorruptedRecording, ReportsADamagedAttachment) {
  const TemporaryDirectory directory;
  write_sample(directory / "a.mcap", 10);
  std::string bytes = contents_of(directory / "a.mcap");
  bytes[bytes.find("period_s")] = 'q';
  put_contents(directory / "a.mcap", bytes);
  EXPECT_THAT(check(directory / "a.mcap").problems,
              testing::ElementsAre(HasSubstr("attachment is damaged and skipped: CRC is wrong")));
}

TEST(Repair, WritesAWholeRecordingOfWhatCanBeRead) {
  const TemporaryDirectory directory;
  const Chunked recording = chunked_recording(directory);
  put_contents(directory / "cut.mcap", recording.bytes.substr(0, recording.ends[5] + 17));
  const CheckReport report = repair(directory / "cut.mcap", directory / "good.mcap");
  EXPECT_EQ(report.messages, 120U);
  EXPECT_THAT(report.problems, Not(IsEmpty()));
  const CheckReport after = check(directory / "good.mcap");
  EXPECT_EQ(after.messages, 120U);
  EXPECT_THAT(after.problems, IsEmpty());
  McapReader reader{directory / "good.mcap"};
  bool genuine = false;
  EXPECT_EQ(sequences_in(reader, &genuine), first_numbers(120));
  EXPECT_TRUE(genuine);
  for (const auto& entry : std::filesystem::directory_iterator{directory / ""})
    EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
}

TEST(Repair, KeepsMetadataAndAttachmentsOfAWholeRecording) {
  const TemporaryDirectory directory;
  write_sample(directory / "a.mcap", 250);
  repair(directory / "a.mcap", directory / "b.mcap");
  EXPECT_EQ(contents_of(directory / "a.mcap"), contents_of(directory / "b.mcap"));
}

TEST(Repair, DoesNotOverwriteTheDamagedFile) {
  const TemporaryDirectory directory;
  write_sample(directory / "a.mcap", 5);
  EXPECT_THROW(repair(directory / "a.mcap", directory / "a.mcap"), WriteError);
  EXPECT_EQ(check(directory / "a.mcap").messages, 5U);
}

}  // namespace
}  // namespace crane::recording
