/// A process has real-time scheduling while its loop runs, and ends with ordinary scheduling.
#include "crane/runtime/realtime_scheduling.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <latch>
#include <optional>
#include <string>
#include <thread>

namespace crane::runtime {
namespace {

constexpr int kDenied = 77;

bool every_thread_has(int policy) {
  for (const auto& thread : std::filesystem::directory_iterator{"/proc/self/task"})
    if (::sched_getscheduler(std::stoi(thread.path().filename().string())) != policy) return false;
  return true;
}

/// @return exit code: 0, kDenied, or the number of the expectation that failed
int enter_and_leave_beside_a_thread() {
  std::latch done{1};
  const std::jthread other{[&done] { done.wait(); }};
  std::optional<RealtimeScheduling> scheduling{std::in_place};
  const auto answer = scheduling->enter(1);
  const bool entered = every_thread_has(SCHED_FIFO);
  scheduling.reset();
  const bool left = every_thread_has(SCHED_OTHER);
  done.count_down();
  if (answer.scheduling != 0) return kDenied;
  if (!entered) return 1;
  return left ? 0 : 2;
}

TEST(RealtimeScheduling, HoldsForEveryThreadUntilItsEnd) {
  const pid_t child = ::fork();  // this process keeps its scheduling
  if (child == 0) ::_exit(enter_and_leave_beside_a_thread());
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kDenied) GTEST_SKIP() << "SCHED_FIFO is not permitted";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(RealtimeScheduling, WithPriorityZeroChangesNothing) {
  const int before = ::sched_getscheduler(0);
  RealtimeScheduling scheduling;
  const auto answer = scheduling.enter(0);
  EXPECT_EQ(answer.memory, 0);
  EXPECT_EQ(answer.scheduling, 0);
  EXPECT_TRUE(every_thread_has(before));
}

}  // namespace
}  // namespace crane::runtime
