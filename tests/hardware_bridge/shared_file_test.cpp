/// The shared memory of an emulated rig: programs of other users neither read nor change it.
#include "crane/boards/shared_lines.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

namespace crane::bridge::test {
namespace {

constexpr uid_t kNobody = 65534;

std::string private_name(const char* what) {
  return "/crane_shared_file_test_" + std::to_string(::getpid()) + "_" + what;
}

/// Runs `action` in a child process. @return result of `action`; false when the process is killed
bool in_a_process(const std::function<bool()>& action) {
  const auto child = ::fork();
  if (child == 0) ::_exit(action() ? 0 : 1);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}
bool as_another_user(const std::function<bool()>& attack) {
  return in_a_process([&] { return ::setuid(kNobody) == 0 && attack(); });
}

/// Gives this process a private, full /dev/shm.
bool fill_shared_memory() {
  if (::unshare(CLONE_NEWNS) != 0 || ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      ::mount("tmpfs", "/dev/shm", "tmpfs", 0, "size=4k") != 0)
    return false;
  const int filler = ::shm_open("/filler", O_RDWR | O_CREAT, 0600);
  const bool full = ::posix_fallocate(filler, 0, 4096) == 0;
  ::close(filler);
  return full;
}

class SharedFileTest : public testing::Test {
 protected:
  ~SharedFileTest() override { ::shm_unlink(name_.c_str()); }
  const std::string name_ = private_name(testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(SharedFileTest, IsAccessibleToItsOwnerOnly) {
  const auto before = ::umask(0);
  const SharedFile file{name_};
  ::umask(before);
  struct stat status {};
  ASSERT_EQ(::stat(("/dev/shm" + name_).c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(SharedFileTest, OfAnEarlierVersionBecomesAccessibleToItsOwnerOnly) {
  const int earlier = ::shm_open(name_.c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_EQ(::fchmod(earlier, 0666), 0);
  ::close(earlier);
  const SharedFile file{name_};
  struct stat status {};
  ASSERT_EQ(::stat(("/dev/shm" + name_).c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(SharedFileTest, CannotBeOpenedByAnotherUserAndNamesTheRemedy) {
  if (::geteuid() != 0) GTEST_SKIP() << "another user needs root";
  const SharedFile file{name_};
  EXPECT_FALSE(as_another_user([this] { return ::shm_open(name_.c_str(), O_RDWR, 0) >= 0; }));
  EXPECT_TRUE(as_another_user([this] {
    try {
      const SharedFile foreign{name_};
    } catch (const BoardError& error) {
      return testing::Matches(testing::HasSubstr("another user"))(error.what());
    }
    return false;
  }));
}

/// Without a check, the first access to the memory would end the process with SIGBUS.
TEST_F(SharedFileTest, IsRefusedWhenTheMemoryOfTheComputerIsFull) {
  if (::geteuid() != 0) GTEST_SKIP() << "a /dev/shm of its own needs root";
  EXPECT_TRUE(in_a_process([this] {
    if (!fill_shared_memory()) return false;
    try {
      SharedFile file{name_};
      *static_cast<volatile char*>(file.map(sizeof(SharedLines))) = 1;
    } catch (const BoardError& error) {
      return testing::Matches(testing::AllOf(testing::HasSubstr(name_), testing::HasSubstr("No space left")))(
          std::string{error.what()});
    }
    return false;
  }));
}

/// Another user created the file first: a program of this user could change the rig.
TEST_F(SharedFileTest, OfAnotherUserIsRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "another user needs root";
  ASSERT_TRUE(as_another_user([this] {
    const int file = ::shm_open(name_.c_str(), O_RDWR | O_CREAT, 0666);
    return file >= 0 && ::fchmod(file, 0666) == 0;
  }));
  try {
    const SharedFile file{name_};
    FAIL() << "the file was accepted";
  } catch (const BoardError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr(name_), testing::HasSubstr("another user")));
  }
}

}  // namespace
}  // namespace crane::bridge::test
