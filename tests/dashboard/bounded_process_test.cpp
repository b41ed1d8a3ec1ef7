#include "dashboard/bounded_process.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <thread>

#include "../recording/temporary_directory.hpp"

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
  /// Polls until it has ended.
  static BoundedProcess::End end_of(BoundedProcess& process) {
    for (const auto give_up = std::chrono::steady_clock::now() + 30s;
         std::chrono::steady_clock::now() < give_up; std::this_thread::sleep_for(5ms))
      if (auto end = process.poll()) return *end;
    return {-2, "still runs"};
  }
  [[nodiscard]] std::string output() const { return contents_of(directory_ / "output"); }
  recording::TemporaryDirectory directory_;
};

TEST_F(BoundedProcessTest, LeavesItsOutputItsErrorsAndItsExitCode) {
  const auto process = shell("echo out; echo err >&2; exit 3");
  EXPECT_EQ(end_of(*process).exit_code, 3);
  EXPECT_EQ(output(), "out\n");
  EXPECT_EQ(contents_of(directory_ / "errors"), "err\n");
}

TEST_F(BoundedProcessTest, EndsWhenItsTimeIsOver) {
  const auto process = shell("sleep 60", {1s, 1ULL << 32U, 1ULL << 20U});
  const auto end = end_of(*process);
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

TEST_F(BoundedProcessTest, TakesWhatItHasStartedWithIt) {
  auto process = shell("sleep 60 & echo $!; wait");
  for (int i = 0; i < 2000 && output().empty(); ++i) std::this_thread::sleep_for(5ms);
  const auto grandchild = static_cast<pid_t>(std::stol(output()));
  ASSERT_EQ(::kill(grandchild, 0), 0);
  process.reset();
  const auto gone = [grandchild] {  // ended, or a zombie that nobody has waited for
    const auto stat = contents_of("/proc/" + std::to_string(grandchild) + "/stat");
    return stat.empty() || stat.find(") Z") != std::string::npos;
  };
  for (int i = 0; i < 2000 && !gone(); ++i) std::this_thread::sleep_for(5ms);
  EXPECT_TRUE(gone());
}

}  // namespace
}  // namespace crane::dashboard
