#include "dashboard/bounded_process.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>

#include "../recording/temporary_directory.hpp"
#include "child_exit.hpp"

namespace crane::dashboard {
namespace {

using namespace std::chrono_literals;
using recording::contents_of;

constexpr Bounds kWide{30s, 1ULL << 32U, 1ULL << 20U};

class BoundedProcessTest : public testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<BoundedProcess> shell(const std::string& script,
                                                      const Bounds& bounds = kWide) const {
    return std::make_unique<BoundedProcess>("/bin/bash", std::vector<std::string>{"-c", script},
                                            directory_ / "output", directory_ / "errors", bounds);
  }
  /// Waits until the process has ended, or until its time is over.
  static BoundedProcess::End end_of(BoundedProcess& process, const Bounds& bounds = kWide) {
    ends_within(process.pid(), bounds.time);
    for (;;)
      if (auto end = process.poll()) return *end;
  }
  [[nodiscard]] std::string output() const { return contents_of(directory_ / "output"); }
  recording::TemporaryDirectory directory_;
};

TEST_F(BoundedProcessTest, GivesItsOutputItsErrorsAndItsExitCode) {
  const auto process = shell("echo out; echo err >&2; exit 3");
  EXPECT_EQ(end_of(*process).exit_code, 3);
  EXPECT_EQ(output(), "out\n");
  EXPECT_EQ(contents_of(directory_ / "errors"), "err\n");
}

TEST_F(BoundedProcessTest, EndsWhenItsTimeIsOver) {
  const Bounds bounds{1s, 1ULL << 32U, 1ULL << 20U};
  const auto process = shell("sleep 60", bounds);
  const auto end = end_of(*process, bounds);
  EXPECT_EQ(end.exit_code, -1);
  EXPECT_EQ(end.how, "took longer than 1 s");
}

TEST_F(BoundedProcessTest, CannotTakeMoreMemoryThanItsBound) {
  const auto process =
      shell("x=$(head -c 300000000 /dev/zero | tr '\\0' x); echo ${#x}", {30s, 200ULL << 20U, 1ULL << 20U});
  EXPECT_NE(end_of(*process).exit_code, 0);
  EXPECT_EQ(output(), "");
}

TEST_F(BoundedProcessTest, CannotWriteAFileLargerThanItsBound) {
  const auto process = shell("head -c 5000000 /dev/zero; exit 0", kWide);
  end_of(*process);
  EXPECT_LE(std::filesystem::file_size(directory_ / "output"), kWide.largest_file_bytes);
}

TEST_F(BoundedProcessTest, HasNoDescriptorsOfItsParentAndTheLowestPriority) {
  const int kept = ::dup(1);
  const auto process = shell("ls /proc/self/fd | wc -l; nice");
  EXPECT_EQ(end_of(*process).exit_code, 0);
  EXPECT_EQ(output(), "4\n19\n");  // 0, 1, 2, and the directory that ls reads
  ::close(kept);
}

TEST_F(BoundedProcessTest, EndsWithAllProcessesThatItHasStarted) {
  const auto pipe = directory_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto process = shell("sleep 60 & echo $! > " + pipe.string() + "; wait");
  pid_t grandchild = 0;
  std::ifstream{pipe} >> grandchild;  // opens when the script writes
  ASSERT_GT(grandchild, 0);
  ASSERT_EQ(::kill(grandchild, 0), 0);
  process.reset();
  EXPECT_TRUE(ends_within(grandchild, 10s));
}

}  // namespace
}  // namespace crane::dashboard
