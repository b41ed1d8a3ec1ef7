#include "crane/files/complete_file.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <iostream>

#include "temporary_directory.hpp"

namespace crane::files {
namespace {

using recording::contents_of;
using recording::put_contents;
using testing::HasSubstr;

class Replaced : public testing::Test {
 protected:
  static void replace(const std::filesystem::path& target,
                      std::span<const std::filesystem::path> sources = {}) {
    CompleteFile complete{target, sources};
    put_contents(complete.partial(), "new");
    complete.publish();
  }
  static std::string refusal_of(const std::filesystem::path& target,
                                std::span<const std::filesystem::path> sources = {}) {
    try {
      replace(target, sources);
    } catch (const WriteError& error) {
      return error.what();
    }
    return "accepted";
  }
  /// Names of all files of the directory, sorted.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator{directory / ""})
      all.push_back(entry.path().filename());
    std::sort(all.begin(), all.end());
    return all;
  }
  recording::TemporaryDirectory directory;
  std::filesystem::path file = directory / "file";
};

TEST_F(Replaced, FileAppearsOnlyWhenItIsPublished) {
  {
    const CompleteFile complete{file};
    put_contents(complete.partial(), "half");
    EXPECT_FALSE(std::filesystem::exists(file));
  }
  EXPECT_THAT(names(), testing::IsEmpty());
  replace(file);
  EXPECT_EQ(contents_of(file), "new");
}

TEST_F(Replaced, FileKeepsItsPermissionsAndALinkToIt) {
  put_contents(file, "old");
  std::filesystem::permissions(file,
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  const auto link = directory / "link";
  std::filesystem::create_symlink("file", link);
  replace(link);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(contents_of(file), "new");
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(Replaced, DevicesPipesAndLinksToMissingFilesAreRefused) {
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_THAT(refusal_of(file), HasSubstr("is no regular file"));
  EXPECT_THAT(refusal_of("/dev/null"), HasSubstr("is no regular file"));
  EXPECT_THAT(refusal_of(directory / ""), HasSubstr("is no regular file"));
  std::filesystem::create_symlink("missing", directory / "link");
  EXPECT_THAT(refusal_of(directory / "link"), HasSubstr("is a link to a missing file"));
}

TEST_F(Replaced, AFileThatIsReadIsRefusedUnderEachOfItsNames) {
  put_contents(file, "precious");
  std::filesystem::create_hard_link(file, directory / "hard");
  std::filesystem::create_symlink("file", directory / "link");
  const std::array sources{file};
  for (const char* name : {"file", "hard", "link"})
    EXPECT_THAT(refusal_of(directory / name, sources), HasSubstr("is a file that the command reads"));
  EXPECT_EQ(contents_of(file), "precious");
}

/// A user may have files with any name beside the result.
TEST_F(Replaced, NoOtherFileIsTouched) {
  put_contents(directory / "file.partial", "precious");
  const std::array sources{directory / "file.partial"};
  replace(file, sources);
  EXPECT_THAT(names(), testing::ElementsAre("file", "file.partial"));
  EXPECT_EQ(contents_of(directory / "file.partial"), "precious");
}

TEST_F(Replaced, ANewFileHasThePermissionsOfTheUser) {
  const auto mask = ::umask(0027);
  replace(file);
  ::umask(mask);
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

/// A limit of the size of files acts like a full disk.
TEST_F(Replaced, FileStaysAsItWasWhenTheDiskIsFull) {
  put_contents(file, "old");
  const auto write_and_exit = [&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{10'000, 10'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_file(file, std::string(100'000, 'x'));
    } catch (const WriteError& error) {
      std::cerr << error.what();
    }
    std::exit(3);
  };
  EXPECT_EXIT(write_and_exit(), testing::ExitedWithCode(3), "file: cannot write: File too large");
  EXPECT_EQ(contents_of(file), "old");
  EXPECT_THAT(names(), testing::ElementsAre("file"));
}

TEST_F(Replaced, FileStaysAsItWasWhenItsContentCannotBeMade) {
  put_contents(file, "old");
  const auto half = [](std::ostream& out) {
    out << "half";
    throw std::runtime_error("no more");
  };
  EXPECT_THROW(write_file(file, half), std::runtime_error);
  EXPECT_EQ(contents_of(file), "old");
  EXPECT_THAT(names(), testing::ElementsAre("file"));
}

TEST_F(Replaced, DevicesReceiveTheTextOfWriteFile) {
  EXPECT_NO_THROW(write_file("/dev/null", "text"));
  try {
    write_file("/dev/full", "text");
    FAIL() << "accepted";
  } catch (const WriteError& error) {
    EXPECT_STREQ(error.what(), "/dev/full: cannot write: No space left on device");
  }
}

TEST_F(Replaced, AMissingDirectoryIsNamed) {
  EXPECT_EQ(refusal_of("/nowhere/file"), "/nowhere/file: cannot write: No such file or directory");
}

TEST(RequireWritable, ChangesNothingAndRefusesADirectory) {
  const recording::TemporaryDirectory directory;
  require_writable(directory / "new.csv");
  EXPECT_FALSE(std::filesystem::exists(directory / "new.csv"));
  std::filesystem::create_directory(directory / "taken.csv");
  EXPECT_THROW(require_writable(directory / "taken.csv"), WriteError);
}

}  // namespace
}  // namespace crane::files
