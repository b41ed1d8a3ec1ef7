#include "crane/files/directory_lock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "crane/files/complete_file.hpp"
#include "temporary_directory.hpp"

namespace crane::files {
namespace {

/// Two programs add lines to one file. A lock belongs to the descriptor of the directory, so that two threads
/// exclude each other as two processes do.
TEST(DirectoryLock, KeepsTheChangesOfBothPrograms) {
  const recording::TemporaryDirectory directory;
  const auto file = directory / "rig.toml";
  write_file(file, "");
  constexpr int kLines = 200;
  const auto add_lines = [&file] {
    for (int i = 0; i < kLines; ++i) {
      const DirectoryLock lock{file.parent_path()};
      write_file(file, recording::contents_of(file) + "line\n");
    }
  };
  std::thread other{add_lines};
  add_lines();
  other.join();
  EXPECT_EQ(std::ranges::count(recording::contents_of(file), '\n'), 2 * kLines);
}

TEST(DirectoryLock, IsRefusedAtOnceWhenAnotherProgramHasIt) {
  const recording::TemporaryDirectory directory;
  const DirectoryLock first{directory / ""};
  EXPECT_THAT([&] { const DirectoryLock second(directory / "", IfLocked::fail); },
              testing::ThrowsMessage<WriteError>(testing::HasSubstr("another program writes into it")));
}

TEST(DirectoryLock, OfAFileNameWithoutDirectoryLocksThePresentDirectory) {
  EXPECT_NO_THROW(DirectoryLock{std::filesystem::path{"rig.toml"}.parent_path()});
}

TEST(DirectoryLock, NamesADirectoryThatDoesNotExist) {
  EXPECT_THROW(DirectoryLock{"/does/not/exist"}, WriteError);
}

}  // namespace
}  // namespace crane::files
