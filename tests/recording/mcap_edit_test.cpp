// Cut and merged recordings.
#include "crane/recording/mcap_edit.hpp"

#include <gmock/gmock.h>

#include "sample_recording.hpp"
#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The parts of a message that a copy must keep.
struct Copied {
  std::string topic;
  std::uint32_t sequence;
  std::int64_t log_time_ns, publish_time_ns;
  std::vector<std::uint8_t> data;
  bool operator==(const Copied&) const = default;
};

std::vector<Copied> copied(const std::filesystem::path& file) {
  std::vector<Copied> list;
  McapReader reader{file};
  EXPECT_TRUE(reader.indexed());
  reader.for_each({}, [&](const Message& message) {
    list.push_back({message.channel->topic,
                    message.sequence,
                    message.log_time_ns,
                    message.publish_time_ns,
                    {message.data.begin(), message.data.end()}});
    return true;
  });
  EXPECT_THAT(reader.problems(), IsEmpty());
  return list;
}

std::vector<std::string> names_of_metadata(const std::filesystem::path& file) {
  std::vector<std::string> names;
  McapReader reader{file};
  for (const auto& record : reader.metadata()) names.push_back(record.name);
  return names;
}

std::string reason_of(const std::function<void()>& edit) {
  try {
    edit();
  } catch (const EditError& error) {
    return error.what();
  }
  return "done";
}

class Edit : public testing::Test {
 protected:
  void SetUp() override { write_sample(whole_, 500); }
  /// A recording with one channel and one attachment.
  void write_other(const std::filesystem::path& file, const std::string& schema, const std::string& topic,
                   const std::string& rig) const {
    McapWriter writer{file};
    const auto channel =
        writer.channel(writer.schema("crane::CraneState", "omgidl", schema), topic, "cdr", {{"unit", "SI"}});
    writer.message(channel, 1, kStart_ns, kStart_ns, payload_of(1));
    writer.attachment("other.toml", "application/toml", kStart_ns,
                      {reinterpret_cast<const std::uint8_t*>(rig.data()), rig.size()});
    writer.close();
  }
  TemporaryDirectory directory_;
  std::filesystem::path whole_ = directory_ / "whole.mcap", out_ = directory_ / "out.mcap";
};

TEST_F(Edit, ACutHasTheMessagesOfItsTimesChannelsMetadataAndAttachments) {
  const auto report = cut(whole_, {.from_s = 1, .until_s = 1.5}, out_);
  EXPECT_EQ(report.messages, 50U);
  McapReader reader{out_};
  bool genuine = false;
  const auto sequences = sequences_in(reader, &genuine);
  EXPECT_TRUE(genuine);
  ASSERT_EQ(sequences.size(), 50U);
  EXPECT_EQ(sequences.front(), 100U);
  EXPECT_EQ(sequences.back(), 149U);
  EXPECT_THAT(names_of_metadata(out_), ElementsAre("run", "cut"));
  const auto attachments = reader.attachments();
  ASSERT_EQ(attachments.size(), 1U);
  EXPECT_EQ(attachments[0].name, "rig.toml");
  EXPECT_EQ(attachments[0].media_type, "application/toml");
  EXPECT_EQ(attachments[0].time_ns, kStart_ns);
  EXPECT_EQ(std::string(attachments[0].data.begin(), attachments[0].data.end()), "period_s = 0.01\n");
  ASSERT_EQ(reader.channels().size(), 2U);
  EXPECT_EQ(reader.channels()[0].metadata, (Metadata{{"unit", "SI"}}));
  EXPECT_EQ(reader.find_schema(reader.channels()[0].schema_id)->text, "module crane {};");
  EXPECT_THAT(check(out_).problems, IsEmpty());
}

TEST_F(Edit, MergedConsecutiveCutsAreTheWholeRecording) {
  const std::vector<std::filesystem::path> parts{directory_ / "2", directory_ / "0", directory_ / "1"};
  (void)cut(whole_, {.from_s = 3.333}, parts[0]);
  (void)cut(whole_, {.until_s = 1.27}, parts[1]);
  (void)cut(whole_, {.from_s = 1.27, .until_s = 3.333}, parts[2]);
  EXPECT_EQ(merge(parts, out_).messages, 500U);
  EXPECT_EQ(copied(out_), copied(whole_));
  McapReader reader{out_};
  EXPECT_EQ(reader.attachments().size(), 1U) << "equal attachments are stored once";
  EXPECT_EQ(reader.channels().size(), 2U);
  EXPECT_EQ(reader.schemas().size(), 1U);
  EXPECT_THAT(names_of_metadata(out_), ElementsAre("run", "cut", "cut", "cut", "merge"));
}

TEST_F(Edit, MessagesOfEqualTimeKeepTheOrderOfTheFilesAndTheirOwnOrder) {
  const auto write = [](const std::filesystem::path& file, const std::string& topic) {
    McapWriter writer{file, {.chunk_bytes = 200}};
    const auto channel = writer.channel(0, topic, "json");
    for (std::uint32_t i = 0; i < 40; ++i)  // four messages of each time
      writer.message(channel, i, kStart_ns + (i / 4) * kTick_ns, 0, payload_of(i));
    writer.close();
  };
  const std::vector<std::filesystem::path> files{directory_ / "b.mcap", directory_ / "a.mcap"};
  write(files[0], "b");
  write(files[1], "a");
  (void)merge(files, out_);
  const auto messages = copied(out_);
  ASSERT_EQ(messages.size(), 80U);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto time = i / 8, place = i % 8;  // b b b b a a a a
    EXPECT_EQ(messages[i].topic, place < 4 ? "b" : "a") << i;
    EXPECT_EQ(messages[i].sequence, 4 * time + place % 4) << i;
  }
}

TEST_F(Edit, RefusesContradictionsAndNamesAllOfThem) {
  const std::vector<std::filesystem::path> files{whole_, directory_ / "other.mcap"};
  write_other(files[1], "module other {};", "crane/note", "period_s = 0.02\n");
  const auto reason = reason_of([&] { (void)merge(files, out_); });
  EXPECT_THAT(reason, HasSubstr("type crane::CraneState: different schemas"));
  EXPECT_THAT(reason, HasSubstr("topic crane/note: different types or encodings"));
  EXPECT_THAT(reason, HasSubstr("attachments rig.toml and other.toml: different content"));
  EXPECT_THAT(reason, HasSubstr("whole.mcap and "));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Edit, KeepsBothAttachmentsOfEqualContentAndDifferentNames) {
  const std::vector<std::filesystem::path> files{whole_, directory_ / "other.mcap"};
  write_other(files[1], "module crane {};", "crane/state", "period_s = 0.01\n");
  EXPECT_EQ(merge(files, out_).messages, 501U);
  McapReader reader{out_};
  EXPECT_EQ(reader.attachments().size(), 2U);
  EXPECT_EQ(reader.channels().size(), 2U);
}

TEST_F(Edit, RefusesAnEmptyRangeAndWritesNothing) {
  EXPECT_THAT(reason_of([&] { (void)cut(whole_, {.from_s = 5}, out_); }),
              HasSubstr("no message from 5 s to inf s; the recording has 4.99 s"));
  EXPECT_THAT(reason_of([&] { (void)cut(whole_, {.from_s = 2, .until_s = 2}, out_); }),
              HasSubstr("no message from 2 s to 2 s"));
  EXPECT_THAT(reason_of([&] { (void)cut(whole_, {.from_s = -1e300, .until_s = -1e299}, out_); }),
              HasSubstr("no message"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Edit, RefusesItsOwnSourceAndAFileGivenTwice) {
  EXPECT_THROW((void)cut(whole_, {}, whole_), WriteError);
  const std::vector<std::filesystem::path> twice{whole_, whole_};
  EXPECT_THAT(reason_of([&] { (void)merge(twice, out_); }), HasSubstr("is given twice"));
  write_other(directory_ / "other.mcap", "module crane {};", "crane/state", "period_s = 0.01\n");
  const std::vector<std::filesystem::path> files{whole_, directory_ / "other.mcap"};
  EXPECT_THROW((void)merge(files, whole_), WriteError);
  EXPECT_EQ(copied(whole_).size(), 500U);
}

TEST_F(Edit, CopiesTheReadablePartOfADamagedRecordingAndReportsTheLoss) {
  const auto bytes = contents_of(whole_);
  put_contents(whole_, bytes.substr(0, bytes.size() / 2));
  const auto report = cut(whole_, {.from_s = 0.5}, out_);
  EXPECT_GT(report.messages, 10U);
  EXPECT_LT(report.messages, 450U);
  EXPECT_FALSE(report.problems.empty());
  EXPECT_THAT(check(out_).problems, IsEmpty());
}

TEST_F(Edit, ReplacesAnExistingFileOnlyWhenComplete) {
  put_contents(out_, "before");
  EXPECT_NE(reason_of([&] { (void)cut(whole_, {.from_s = 5}, out_); }), "done");
  EXPECT_EQ(contents_of(out_), "before");
  (void)cut(whole_, {}, out_);
  EXPECT_EQ(copied(out_), copied(whole_));
  for (const auto& entry : std::filesystem::directory_iterator{out_.parent_path()})
    EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
}

}  // namespace
}  // namespace crane::recording
