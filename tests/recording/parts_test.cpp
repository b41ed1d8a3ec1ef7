// A recording of several files: names, and reading them as one recording.
#include "crane/recording/parts.hpp"

#include <gmock/gmock.h>

#include "crane/recording/mcap_edit.hpp"
#include "sample_recording.hpp"
#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Part `number` with the messages [first, end) of write_sample().
void write_part(const std::filesystem::path& recording, std::uint32_t number, std::uint32_t first,
                std::uint32_t end, const std::string& started_ns = "7",
                const std::string& topic = "crane/note") {
  McapWriter writer{part_file(recording, number), {.chunk_bytes = 700}};
  const auto schema = writer.schema("crane::CraneState", "omgidl", "module crane {};");
  const std::uint16_t even = writer.channel(schema, "crane/state", "cdr", {{"unit", "SI"}});
  const std::uint16_t odd = writer.channel(0, topic, "json");
  writer.metadata("crane", {{"started_ns", started_ns}});
  writer.metadata("part", {{"number", std::to_string(number)}});
  for (std::uint32_t i = first; i < end; ++i) {
    const std::int64_t time_ns = kStart_ns + kTick_ns * i;
    writer.message(i % 2 == 0 ? even : odd, i, time_ns, time_ns + 7, recording::payload_of(i));
  }
  writer.close();
}

std::string reason_of(const std::filesystem::path& recording) {
  try {
    McapReader{recording};
  } catch (const ReadError& error) {
    return error.what();
  }
  return "read";
}

class Parts : public testing::Test {
 protected:
  void write_three() const {
    write_part(run_, 1, 0, 100);
    write_part(run_, 2, 100, 250);
    write_part(run_, 3, 250, 300);
  }
  TemporaryDirectory directory_;
  std::filesystem::path run_ = directory_ / "run.mcap";
};

TEST_F(Parts, HaveNamesThatSortLikeTheirNumbers) {
  EXPECT_EQ(part_file("out/run.mcap", 2), "out/run_000002.mcap");
  EXPECT_LT(part_file("run.mcap", 9), part_file("run.mcap", 10));
  EXPECT_LT(part_file("run.mcap", 99'999), part_file("run.mcap", 100'000));
  EXPECT_EQ(part_file("a.b.mcap", 1), "a.b_000001.mcap");
}

TEST_F(Parts, AreFoundInTheOrderOfTheirNumbersWithoutOtherFiles) {
  for (const char* name :
       {"run_000010.mcap", "run_000002.mcap", "run_1000000.mcap", "run_2.mcap", "run_0000003.mcap",
        "run_000000.mcap", "run_00000x.mcap", "other_000001.mcap", "run_000001.csv", "run.mcap"})
    put_contents(directory_ / name, "x");
  std::vector<std::uint32_t> numbers;
  for (const auto& part : parts_of(run_)) numbers.push_back(part.number);
  EXPECT_THAT(numbers, ElementsAre(2, 10, 1'000'000));
  EXPECT_THAT(files_of(run_), ElementsAre(run_)) << "the file of this name precedes its parts";
  std::filesystem::remove(run_);
  EXPECT_EQ(files_of(run_).size(), 3U);
}

TEST_F(Parts, AreReadAsOneRecording) {
  write_three();
  McapReader reader{run_};
  bool genuine = false;
  EXPECT_EQ(sequences_in(reader, &genuine), first_numbers(300));
  EXPECT_TRUE(genuine);
  EXPECT_TRUE(reader.indexed());
  EXPECT_EQ(reader.first_time_ns(), kStart_ns);
  EXPECT_EQ(reader.last_time_ns(), kStart_ns + kTick_ns * 299);
  EXPECT_EQ(reader.channels().size(), 2U);
  EXPECT_EQ(reader.metadata().size(), 6U);
  EXPECT_THAT(reader.problems(), IsEmpty());
  EXPECT_EQ(check(run_).messages, 300U);
}

TEST_F(Parts, AreReadSinglyByTheirOwnNames) {
  write_three();
  McapReader reader{part_file(run_, 2)};
  bool genuine = false;
  EXPECT_EQ(sequences_in(reader, &genuine).size(), 150U);
  EXPECT_TRUE(genuine);
}

TEST_F(Parts, AreReadUpToTheDamageOfOneAndFromTheNext) {
  write_three();
  const auto second = part_file(run_, 2);
  std::filesystem::resize_file(second, std::filesystem::file_size(second) / 2);
  put_contents(part_file(run_, 4), "");
  const auto found = check(run_);
  EXPECT_GT(found.messages, 160U);
  EXPECT_LT(found.messages, 300U);
  EXPECT_THAT(found.problems, testing::Contains(HasSubstr("run_000002.mcap: has no usable index")));
  EXPECT_THAT(found.problems, testing::Contains(HasSubstr("run_000004.mcap: is empty")));
}

TEST_F(Parts, ReportAMissingPartBetweenTwoOthersButNotBeforeTheFirst) {
  write_three();
  std::filesystem::remove(part_file(run_, 1));
  EXPECT_THAT(check(run_).problems, IsEmpty());
  write_part(run_, 5, 400, 410);
  EXPECT_THAT(check(run_).problems, ElementsAre(HasSubstr("run_000005.mcap: the part before it is missing")));
}

TEST_F(Parts, OfDifferentRecordingsAreRefused) {
  write_part(run_, 1, 0, 100);
  write_part(run_, 2, 100, 200, "8");
  EXPECT_THAT(reason_of(run_), testing::AllOf(HasSubstr("run_000002.mcap"), HasSubstr("another recording")));
  write_part(run_, 2, 100, 200, "7", "crane/other");
  EXPECT_THAT(reason_of(run_),
              testing::AllOf(HasSubstr("run_000002.mcap"), HasSubstr("other types or topics")));
}

TEST_F(Parts, AreMergedToOneFileThatIsNoneOfThem) {
  write_three();
  const auto out = directory_ / "joined.mcap";
  EXPECT_EQ(merge(std::array{run_}, out).messages, 300U);
  McapReader reader{out};
  bool genuine = false;
  EXPECT_EQ(sequences_in(reader, &genuine), first_numbers(300));
  EXPECT_TRUE(genuine);
  EXPECT_THROW((void)merge(std::array{run_}, part_file(run_, 2)), WriteError);
  EXPECT_THROW((void)repair(run_, part_file(run_, 3)), WriteError);
  EXPECT_EQ(check(run_).messages, 300U);
}

TEST(Writer, PredictsTheSizeOfTheClosedFileFromAbove) {
  const TemporaryDirectory directory;
  for (const std::uint32_t messages : {0U, 1U, 30U, 1000U}) {
    const auto file = directory / (std::to_string(messages) + ".mcap");
    McapWriter writer{file, {.chunk_bytes = 5000}};
    const auto channel = writer.channel(0, "crane/note", "json");
    writer.metadata("run", {{"rig", "virginia_tech_tower"}});
    std::uint64_t bound = writer.closed_bytes(0);
    for (std::uint32_t i = 0; i < messages; ++i) {
      const auto data = recording::payload_of(i);
      bound = writer.closed_bytes(data.size());
      writer.message(channel, i, kTick_ns * i, 0, data);
    }
    writer.close();
    EXPECT_LE(std::filesystem::file_size(file), bound) << messages;
    EXPECT_LT(bound, std::filesystem::file_size(file) + 8000U) << messages;
  }
}

TEST(Writer, KeepsAnExistingFileUnlessItMayReplaceIt) {
  const TemporaryDirectory directory;
  put_contents(directory / "a.mcap", "precious");
  EXPECT_THROW((McapWriter{directory / "a.mcap", {.replace = false}}), WriteError);
  EXPECT_EQ(contents_of(directory / "a.mcap"), "precious");
}

TEST(Writer, NoticesThatItsFileWasDeletedButNotThatItWasRenamed) {
  const TemporaryDirectory directory;
  McapWriter writer{directory / "a.mcap"};
  EXPECT_FALSE(writer.removed());
  std::filesystem::rename(directory / "a.mcap", directory / "b.mcap");
  EXPECT_FALSE(writer.removed());
  std::filesystem::remove(directory / "b.mcap");
  EXPECT_TRUE(writer.removed());
}

}  // namespace
}  // namespace crane::recording
