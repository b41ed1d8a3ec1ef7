// Parts of a recording: limits, quota, files that others delete or replace.
#include "recorder/recording_files.hpp"

#include <gmock/gmock.h>
#include <sys/mount.h>
#include <sys/stat.h>

#include <numeric>

#include "crane/recording/parts.hpp"
#include "recorder_entries.hpp"
#include "temporary_directory.hpp"

namespace crane::recorder {
namespace {

using recording::LossCause;
using recording::McapReader;
using recording::part_file;
using recording::TemporaryDirectory;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<std::uint32_t> numbers(std::uint32_t first, std::uint32_t end) {
  std::vector<std::uint32_t> list(end - first);
  std::iota(list.begin(), list.end(), first);
  return list;
}

class Files : public testing::Test {
 protected:
  [[nodiscard]] std::uint64_t size_of_all() const {
    std::uint64_t sum = 0;
    for (const auto& part : recording::parts_of(run_)) sum += std::filesystem::file_size(part.file);
    return sum;
  }
  TemporaryDirectory directory_;
  std::filesystem::path run_ = directory_ / "run.mcap";
};

TEST_F(Files, WithoutLimitsAreOneFileOfTheGivenName) {
  auto files = files_for(run_);
  for (std::uint32_t i = 0; i < 300; ++i) files.write(entry(i, 10'000));
  files.close();
  EXPECT_EQ(sequences_in(run_), numbers(0, 300));
  EXPECT_THAT(recording::parts_of(run_), IsEmpty());
  EXPECT_EQ(files.bytes(), std::filesystem::file_size(run_));
}

TEST_F(Files, EndBeforeTheyExceedTheirSizeAndLoseNothing) {
  constexpr std::uint64_t kSize = 200'000;
  auto files = files_for(run_, {.part_bytes = kSize});
  for (std::uint32_t i = 0; i < 300; ++i) files.write(entry(i, 10'000, i % 2));
  files.close();
  const auto parts = recording::parts_of(run_);
  EXPECT_GE(parts.size(), 15U);
  EXPECT_LE(parts.size(), 20U);
  for (const auto& part : parts) {
    EXPECT_LE(std::filesystem::file_size(part.file), kSize);
    EXPECT_THAT(recording::check(part.file).problems, IsEmpty());
  }
  EXPECT_EQ(sequences_in(run_), numbers(0, 300));
  EXPECT_EQ(files.bytes(), size_of_all());
  EXPECT_EQ(files.parts(), parts.size());
}

TEST_F(Files, HoldASampleThatIsLargerThanTheirSize) {
  auto files = files_for(run_, {.part_bytes = 50'000});
  for (std::uint32_t i = 0; i < 5; ++i) files.write(entry(i, 80'000));
  files.close();
  EXPECT_THAT(recording::parts_of(run_), SizeIs(5));
  EXPECT_EQ(sequences_in(run_), numbers(0, 5));
}

TEST_F(Files, BeginAtMultiplesOfTheirTimeAfterTheFirstSample) {
  auto files = files_for(run_, {.part = std::chrono::nanoseconds{100}});
  for (const std::uint32_t time : {30U, 129U, 130U, 229U, 470U, 529U, 530U}) files.write(entry(time));
  files.close();
  EXPECT_THAT(sequences_in(part_file(run_, 1)), ElementsAre(30, 129));
  EXPECT_THAT(sequences_in(part_file(run_, 2)), ElementsAre(130, 229));
  EXPECT_THAT(sequences_in(part_file(run_, 3)), ElementsAre(470, 529)) << "no part of a silent time";
  EXPECT_THAT(sequences_in(part_file(run_, 4)), ElementsAre(530));
  EXPECT_THAT(recording::parts_of(run_), SizeIs(4));
}

TEST_F(Files, AreSelfContained) {
  auto files = files_for(run_, {.part = std::chrono::nanoseconds{10}});
  for (std::uint32_t i = 0; i < 30; ++i) files.write(entry(i));
  files.close();
  for (const auto& part : recording::parts_of(run_)) {
    McapReader reader{part.file};
    EXPECT_THAT(reader.channels(), SizeIs(3));
    EXPECT_TRUE(recording::has_losses_channel(reader));
    ASSERT_THAT(reader.metadata(), SizeIs(2));
    EXPECT_EQ(reader.metadata()[1].entries.at("number"), std::to_string(part.number));
    EXPECT_EQ(reader.metadata()[1].entries.at("recording"), "run.mcap");
    EXPECT_THAT(reader.attachments(), SizeIs(1));
  }
}

TEST_F(Files, OfAQuotaDeleteTheOldestPartsOfTheirRecordingOnly) {
  recording::put_contents(directory_ / "run_000777.mcap", "precious");
  recording::put_contents(directory_ / "run.mcap", "precious");
  constexpr std::uint64_t kQuota = 500'000;
  auto files = files_for(run_, {.part_bytes = 100'000, .quota_bytes = kQuota});
  for (std::uint32_t i = 0; i < 300; ++i) {
    files.write(entry(i, 10'000));
    files.flush();
    EXPECT_LE(size_of_all(), kQuota + 8U);
  }
  files.close();
  EXPECT_LE(files.bytes(), kQuota);
  EXPECT_EQ(recording::contents_of(directory_ / "run_000777.mcap"), "precious");
  EXPECT_EQ(recording::contents_of(directory_ / "run.mcap"), "precious");
  std::filesystem::remove(directory_ / "run_000777.mcap");
  std::filesystem::remove(directory_ / "run.mcap");
  const auto kept = sequences_in(run_);
  EXPECT_GE(kept.size(), 30U);
  EXPECT_EQ(kept, numbers(300 - static_cast<std::uint32_t>(kept.size()), 300)) << "the newest, without a gap";
  EXPECT_THAT(recording::check(run_).problems, IsEmpty());
}

TEST_F(Files, DoNotDeleteAFileThatReplacedOneOfTheirParts) {
  auto files = files_for(run_, {.part_bytes = 100'000, .quota_bytes = 200'000});
  for (std::uint32_t i = 0; i < 10; ++i) files.write(entry(i, 10'000));
  ASSERT_EQ(files.parts(), 2U);
  std::filesystem::remove(part_file(run_, 1));
  recording::put_contents(directory_ / "new", "precious");
  std::filesystem::rename(directory_ / "new", part_file(run_, 1));
  for (std::uint32_t i = 10; i < 100; ++i) files.write(entry(i, 10'000));
  files.close();
  EXPECT_EQ(recording::contents_of(part_file(run_, 1)), "precious");
}

TEST_F(Files, DoNotOverwriteAFileThatHasTheNameOfTheNextPart) {
  recording::put_contents(part_file(run_, 2), "precious");
  auto files = files_for(run_, {.part = std::chrono::nanoseconds{10}});
  files.write(entry(1));
  try {
    files.write(entry(20));
    ADD_FAILURE() << "overwritten";
  } catch (const recording::WriteError& error) {
    EXPECT_THAT(error.what(), HasSubstr("run_000002.mcap: cannot create: File exists"));
  }
  EXPECT_EQ(recording::contents_of(part_file(run_, 2)), "precious");
  EXPECT_THAT(sequences_in(part_file(run_, 1)), ElementsAre(1));
}

TEST_F(Files, ThatAreDeletedWhileWrittenAreReplacedAndTheirSamplesAreALoss) {
  auto files = files_for(run_);
  for (std::uint32_t i = 10; i < 17; ++i) files.write(entry(i));
  files.write(entry(17, 16, 1));
  files.write({.topic = "test", .cause = LossCause::dds_lost, .samples = 3, .from_ns = 5, .until_ns = 6});
  files.flush();
  std::filesystem::remove(run_);
  files.write(entry(18));
  files.flush();
  EXPECT_THAT(files.take_warnings(),
              ElementsAre(testing::AllOf(HasSubstr("run.mcap: was deleted with 9 samples"),
                                         HasSubstr("the recording continues in"))));
  files.write(entry(19));
  files.close();
  EXPECT_THAT(sequences_in(run_), ElementsAre(19));
  McapReader reader{run_};
  const auto losses = recording::losses_in(reader);
  ASSERT_THAT(losses, SizeIs(3));
  EXPECT_EQ(losses[0].cause, LossCause::dds_lost) << "noted in the deleted file";
  EXPECT_EQ(losses[0].samples, 3U);
  EXPECT_EQ(losses[1].topic, "other");
  EXPECT_EQ(losses[2].topic, "test");
  EXPECT_EQ(losses[2].cause, LossCause::file_removed);
  EXPECT_EQ(losses[2].samples, 8U);
  EXPECT_EQ(losses[2].from_ns, 10);
  EXPECT_EQ(losses[2].until_ns, 18);
}

TEST_F(Files, ThatAreRenamedWhileWrittenAreCompletedUnderTheNewName) {
  auto files = files_for(run_, {.part = std::chrono::nanoseconds{10}});
  files.write(entry(1));
  files.flush();
  std::filesystem::rename(part_file(run_, 1), directory_ / "saved.mcap");
  files.write(entry(2));
  files.write(entry(20));
  files.close();
  EXPECT_THAT(sequences_in(directory_ / "saved.mcap"), ElementsAre(1, 2));
  EXPECT_THAT(sequences_in(part_file(run_, 2)), ElementsAre(20));
  EXPECT_THAT(files.take_warnings(), IsEmpty());
}

/// A file system of its own.
class Disk {
 public:
  Disk(std::filesystem::path place, const char* options) : place_{std::move(place)} {
    std::filesystem::create_directory(place_);
    mounted_ = ::mount("tmpfs", place_.c_str(), "tmpfs", 0, options) == 0;
  }
  ~Disk() {
    if (mounted_) ::umount2(place_.c_str(), MNT_DETACH);
  }
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;
  [[nodiscard]] bool mounted() const { return mounted_; }
  [[nodiscard]] bool make_read_only() const {
    return ::mount(nullptr, place_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) == 0;
  }

 private:
  std::filesystem::path place_;
  bool mounted_ = false;
};

TEST_F(Files, OnAFullDiskAreReadableUpToTheFailure) {
  const Disk disk{directory_ / "disk", "size=1m"};
  if (!disk.mounted()) GTEST_SKIP() << "mounting a tmpfs needs CAP_SYS_ADMIN";
  const auto run = directory_ / "disk/run.mcap";
  auto files = files_for(run, {.part_bytes = 300'000});
  std::uint32_t flushed = 0;
  try {
    for (std::uint32_t i = 0; i < 200; ++i) {
      files.write(entry(i, 10'000));
      files.flush();
      flushed = i + 1;
    }
    ADD_FAILURE() << "the disk is not full";
  } catch (const recording::WriteError& error) {
    EXPECT_THAT(error.what(), testing::ContainsRegex("run_00000[34].mcap: cannot write.*No space left"));
  }
  EXPECT_GT(flushed, 60U);
  EXPECT_EQ(sequences_in(run), numbers(0, flushed));
}

TEST_F(Files, OnADiskThatBecomesReadOnlyKeepTheirPartsAndNameTheNextOne) {
  const Disk disk{directory_ / "disk", "size=1m"};
  if (!disk.mounted()) GTEST_SKIP() << "mounting a tmpfs needs CAP_SYS_ADMIN";
  const auto run = directory_ / "disk/run.mcap";
  { files_for(run).close(); }
  ASSERT_TRUE(disk.make_read_only());
  try {
    (void)files_for(directory_ / "disk/other.mcap");
    ADD_FAILURE() << "written";
  } catch (const recording::WriteError& error) {
    EXPECT_THAT(error.what(), HasSubstr("other.mcap: cannot create: Read-only file system"));
  }
  EXPECT_THAT(recording::check(run).problems, IsEmpty());
}

}  // namespace
}  // namespace crane::recorder
