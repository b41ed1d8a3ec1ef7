#include "recorder/recording_thread.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <random>

#include "crane/recording/mcap_reader.hpp"
#include "temporary_directory.hpp"

namespace crane::recorder {
namespace {

using recording::TemporaryDirectory;

Entry entry(std::uint32_t number, std::size_t bytes = 16) {
  std::mt19937 random{number};  // random bytes do not compress, so that the file grows by their size
  Entry result;
  result.sequence = number;
  result.log_time_ns = number;
  result.data.resize(bytes);
  for (auto& byte : result.data) byte = static_cast<std::uint8_t>(random());
  return result;
}

recording::McapWriter writer_for(const std::filesystem::path& file) {
  recording::McapWriter writer{file};
  writer.channel(0, "test", "none");
  return writer;
}

TEST(RecordingThread, WritesEverythingItTookInOrder) {
  const TemporaryDirectory directory;
  const auto file = directory / "run.mcap";
  RecordingThread thread{writer_for(file), 1000};
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
  RecordingThread thread{writer_for(directory / "run.mcap"), 1};
  constexpr std::uint64_t kEntries = 2000;
  for (std::uint32_t i = 0; i < kEntries; ++i) thread.put(entry(i));
  thread.close();
  EXPECT_EQ(thread.written() + thread.dropped(), kEntries);
  EXPECT_EQ(thread.failure(), std::nullopt);
}

TEST(RecordingThread, HasAnUrgentEntryInTheFileWithoutBeingClosed) {
  const TemporaryDirectory directory;
  const auto file = directory / "run.mcap";
  RecordingThread thread{writer_for(file), 100};
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
    RecordingThread thread{writer_for(file), 100};
    for (std::uint32_t i = 0; !thread.failure(); ++i) thread.put(entry(i, 100'000));
    thread.close();
    failure = thread.failure();
  }
  EXPECT_THAT(failure.value_or(""), testing::HasSubstr(file.string()));
  const auto repaired = directory / "repaired.mcap";
  EXPECT_GT(recording::repair(file, repaired).messages, 10U);
  EXPECT_TRUE(recording::check(repaired).problems.empty());
}

}  // namespace
}  // namespace crane::recorder
