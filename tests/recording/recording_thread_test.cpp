#include "recorder/recording_thread.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include "crane/recording/mcap_reader.hpp"
#include "recorder_entries.hpp"
#include "temporary_directory.hpp"

namespace crane::recorder {
namespace {

using recording::TemporaryDirectory;

TEST(RecordingThread, WritesEverythingItTookInOrder) {
  const TemporaryDirectory directory;
  const auto file = directory / "run.mcap";
  RecordingThread thread{files_for(file), 1000};
  for (std::uint32_t i = 0; i < 500; ++i) ASSERT_TRUE(thread.put(entry(i)));
  thread.close();
  EXPECT_EQ(thread.written(), 500U);
  EXPECT_FALSE(thread.put(entry(500))) << "closed";
  recording::McapReader reader{file};
  EXPECT_TRUE(reader.indexed());
  std::uint32_t expected = 0;
  reader.for_each({}, [&](const recording::Message& message) { return message.sequence == expected++; });
  EXPECT_EQ(expected, 500U);
}

TEST(RecordingThread, CountsEveryEntryWhenTheQueueOverflows) {
  const TemporaryDirectory directory;
  RecordingThread thread{files_for(directory / "run.mcap"), 1};
  constexpr std::uint64_t kEntries = 2000;
  for (std::uint32_t i = 0; i < kEntries; ++i) thread.put(entry(i));
  thread.close();
  EXPECT_EQ(thread.written() + thread.dropped(), kEntries);
  EXPECT_GT(thread.dropped(), 0U);
  EXPECT_EQ(thread.failure(), std::nullopt);
  recording::McapReader reader{directory / "run.mcap"};
  std::uint64_t lost = 0;
  for (const auto& loss : recording::losses_in(reader)) {
    EXPECT_EQ(loss.topic, "test");
    EXPECT_EQ(loss.cause, recording::LossCause::queue_full);
    EXPECT_LE(loss.from_ns, loss.until_ns);
    lost += loss.samples;
  }
  EXPECT_EQ(lost, thread.dropped()) << "the file accounts for every dropped sample";
  EXPECT_EQ(sequences_in(directory / "run.mcap").size(), thread.written());
}

TEST(RecordingThread, WritesTheLossesOfEachTopicAndCauseWithTheirTimes) {
  const TemporaryDirectory directory;
  RecordingThread thread{files_for(directory / "run.mcap"), 10};
  thread.lose(0, recording::LossCause::dds_lost, 3, 1000);
  thread.lose(1, recording::LossCause::wrong_crc, 1, 1500);
  thread.lose(0, recording::LossCause::dds_lost, 2, 2000);
  thread.close();
  EXPECT_EQ(thread.lost(), 6U);
  recording::McapReader reader{directory / "run.mcap"};
  std::map<std::string, std::uint64_t> sums;
  for (const auto& loss : recording::losses_in(reader)) sums[loss.topic] += loss.samples;
  EXPECT_THAT(sums, testing::ElementsAre(testing::Pair("other", 1U), testing::Pair("test", 5U)));
}

TEST(RecordingThread, HasAnUrgentEntryInTheFileWithoutBeingClosed) {
  const TemporaryDirectory directory;
  const auto file = directory / "run.mcap";
  RecordingThread thread{files_for(file), 100};
  auto urgent = entry(7);
  urgent.urgent = true;
  thread.put(std::move(urgent));
  while (thread.bytes() == 0) std::this_thread::yield();  // the time limit of the test bounds this loop
  EXPECT_EQ(recording::check(file).messages, 1U);
}

/// A disk with this number of free bytes. The limit applies to the whole process and is removed again.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST(RecordingThread, LeavesAReadableFileWhenTheDiskIsFull) {
  const TemporaryDirectory directory;
  const auto file = directory / "run.mcap";
  std::optional<std::string> failure;
  {
    const FileSizeLimit full{4'000'000};
    RecordingThread thread{files_for(file), 100};
    std::uint32_t put = 0;
    while (!thread.failure()) thread.put(entry(put++, 100'000));
    thread.close();
    failure = thread.failure();
    EXPECT_EQ(thread.written() + thread.dropped(), put);
  }
  EXPECT_THAT(failure.value_or(""), testing::HasSubstr(file.string()));
  const auto repaired = directory / "repaired.mcap";
  EXPECT_GT(recording::repair(file, repaired).messages, 10U);
  EXPECT_TRUE(recording::check(repaired).problems.empty());
}

}  // namespace
}  // namespace crane::recorder
