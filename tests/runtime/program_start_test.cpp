#include "crane/runtime/program_start.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace crane::runtime {
namespace {

/// Closes a standard descriptor for the time of a test.
class Closed {
 public:
  explicit Closed(int descriptor) : descriptor_{descriptor}, copy_{::fcntl(descriptor, F_DUPFD_CLOEXEC, 3)} {
    ::close(descriptor);
  }
  ~Closed() {
    ::dup2(copy_, descriptor_);
    ::close(copy_);
  }
  Closed(const Closed&) = delete;
  Closed& operator=(const Closed&) = delete;

 private:
  int descriptor_, copy_;
};

/// The next file of a program does not get the number of a standard descriptor.
TEST(ProgramStart, OpensTheMissingStandardDescriptors) {
  int next = -1, read = 0, written = 0;
  {
    const Closed in{STDIN_FILENO}, out{STDOUT_FILENO}, errors{STDERR_FILENO};
    start_program();
    next = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    char byte = 0;
    read = ::read(STDIN_FILENO, &byte, 1) < 0 ? errno : 0;
    written = ::write(STDOUT_FILENO, &byte, 1) < 0 ? errno : 0;
    ::close(next);
  }
  EXPECT_GT(next, STDERR_FILENO);
  EXPECT_EQ(read, EBADF);
  EXPECT_EQ(written, EBADF);
}

TEST(ProgramStart, LeavesOpenDescriptorsUnchanged) {
  const Closed before{STDIN_FILENO};
  ASSERT_EQ(::open("/dev/zero", O_RDONLY), STDIN_FILENO);
  start_program();
  char byte = 1;
  EXPECT_EQ(::read(STDIN_FILENO, &byte, 1), 1);
  EXPECT_EQ(byte, 0);
}

}  // namespace
}  // namespace crane::runtime
