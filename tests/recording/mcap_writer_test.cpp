#include "crane/recording/mcap_writer.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include "sample_recording.hpp"
#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

using testing::HasSubstr;

TEST(McapWriter, GivesTheSameBytesForTheSameMessages) {
  const TemporaryDirectory directory;
  write_sample(directory / "a.mcap", 500);
  write_sample(directory / "b.mcap", 500);
  EXPECT_EQ(contents_of(directory / "a.mcap"), contents_of(directory / "b.mcap"));
}

TEST(McapWriter, BeginsAndEndsWithTheMagicBytes) {
  const TemporaryDirectory directory;
  write_sample(directory / "a.mcap", 3);
  const std::string bytes = contents_of(directory / "a.mcap");
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x89MCAP0\r\n", 8));
  EXPECT_EQ(bytes.substr(bytes.size() - 8), std::string("\x89MCAP0\r\n", 8));
}

TEST(McapWriter, WritesEverySecondOfLogTimeToTheFile) {
  const TemporaryDirectory directory;
  McapWriter writer{directory / "a.mcap"};
  const std::uint16_t channel = writer.channel(0, "crane/note", "json");
  const std::uint64_t empty = writer.bytes_written();
  for (std::uint32_t i = 0; i < 100; ++i) writer.message(channel, i, kTick_ns * i, 0, payload_of(i));
  EXPECT_EQ(writer.bytes_written(), empty);
  writer.message(channel, 100, kTick_ns * 100, 0, payload_of(100));
  EXPECT_GT(writer.bytes_written(), empty + 5000U);
  EXPECT_EQ(std::filesystem::file_size(directory / "a.mcap"), writer.bytes_written());
}

TEST(McapWriter, HasEverythingInTheFileAfterAFlush) {
  const TemporaryDirectory directory;
  McapWriter writer{directory / "a.mcap", {.sync = true}};
  const std::uint16_t channel = writer.channel(0, "crane/note", "json");
  for (std::uint32_t i = 0; i < 7; ++i)
    writer.message(channel, i, kStart_ns + kTick_ns * i, kStart_ns + kTick_ns * i + 7, payload_of(i));
  writer.flush();
  McapReader reader{directory / "a.mcap"};
  int count = 0;
  reader.for_each({}, [&](const Message&) { return ++count > 0; });
  EXPECT_EQ(count, 7);
}

TEST(McapWriter, DeclaresEveryTopicWithItsTypeAndTheIdlText) {
  const TemporaryDirectory directory;
  McapWriter writer{directory / "a.mcap"};
  const TopicChannels channels = add_topic_channels(writer);
  writer.close();
  McapReader reader{directory / "a.mcap"};
  ASSERT_EQ(reader.channels().size(), topics::kAll.size());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const ChannelRecord& channel = reader.channels()[i];
    EXPECT_EQ(channel.id, channels[i]);
    EXPECT_EQ(channel.topic, topics::kAll[i].name);
    EXPECT_EQ(channel.message_encoding, "cdr");
    const SchemaRecord* schema = reader.find_schema(channel.schema_id);
    ASSERT_NE(schema, nullptr);
    EXPECT_EQ(schema->name, topics::kAll[i].type);
    EXPECT_EQ(schema->encoding, "omgidl");
    EXPECT_EQ(schema->text, topics::idl_text());
  }
}

TEST(McapWriter, RefusesUndeclaredSchemasAndChannels) {
  const TemporaryDirectory directory;
  McapWriter writer{directory / "a.mcap"};
  EXPECT_THROW(writer.channel(1, "crane/state", "cdr"), std::invalid_argument);
  EXPECT_THROW(writer.message(0, 0, 0, 0, payload_of(0)), std::invalid_argument);
}

TEST(McapWriter, RefusesMessagesAfterClose) {
  const TemporaryDirectory directory;
  McapWriter writer{directory / "a.mcap"};
  const std::uint16_t channel = writer.channel(0, "crane/note", "json");
  writer.close();
  writer.close();
  EXPECT_THROW(writer.message(channel, 0, 0, 0, payload_of(0)), std::logic_error);
}

std::string writing_error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const WriteError& error) {
    return error.what();
  }
  return "no WriteError";
}

TEST(McapWriter, NamesFileAndReasonWhenItCannotCreateTheFile) {
  EXPECT_EQ(writing_error_of([] { McapWriter writer{"/nowhere/a.mcap"}; }),
            "/nowhere/a.mcap: cannot create: No such file or directory");
}

TEST(McapWriter, NamesFileAndReasonWhenTheDiskIsFull) {
  EXPECT_EQ(writing_error_of([] { McapWriter writer{"/dev/full"}; }),
            "/dev/full: cannot write: No space left on device");
}

/// Limits the size of files of this process, like a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_{std::signal(SIGXFSZ, SIG_IGN)} {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(McapWriter, LeavesWholeChunksWhenTheFileCannotGrow) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory / "a.mcap";
  std::string first, again;
  {
    const FileSizeLimit limit{50'000};
    McapWriter writer{file};
    const std::uint16_t state = writer.channel(0, "crane/state", "cdr");
    const std::uint16_t note = writer.channel(0, "crane/note", "json");
    const auto add = [&](std::uint32_t i) {
      const std::int64_t time_ns = kStart_ns + kTick_ns * i;
      writer.message(i % 2 == 0 ? state : note, i, time_ns, time_ns + 7, payload_of(i));
    };
    first = writing_error_of([&] {
      for (std::uint32_t i = 0; i < 2000; ++i) add(i);
    });
    again = writing_error_of([&] { add(2000); });
  }
  EXPECT_EQ(first, file.string() + ": cannot write: File too large");
  EXPECT_EQ(again, first);
  McapReader reader{file};
  bool genuine = false;
  const auto sequences = sequences_in(reader, &genuine);
  EXPECT_TRUE(genuine);
  EXPECT_EQ(sequences, first_numbers(sequences.size()));
  EXPECT_GE(sequences.size(), 303U);  // three chunks of 101 messages of about 130 bytes fit into 50000 bytes
  EXPECT_EQ(sequences.size() % 101, 0U);
  EXPECT_THAT(reader.problems(), testing::ElementsAre(HasSubstr("no usable index")));
}

}  // namespace
}  // namespace crane::recording
