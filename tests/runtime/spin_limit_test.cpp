/// The kernel ends a real-time process that spins; a process that waits continues.
#include "crane/runtime/spin_limit.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <functional>

namespace crane::runtime {
namespace {

constexpr int kNotPermitted = 77;

std::int64_t cpu_ns() {
  timespec used{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return used.tv_sec * 1'000'000'000LL + used.tv_nsec;
}

void compute_for(std::chrono::nanoseconds duration) {
  for (const std::int64_t end_ns = cpu_ns() + duration.count(); cpu_ns() < end_ns;) {
  }
}

/// Runs `work` in a child process with SCHED_FIFO. @return wait status, as of waitpid()
int status_after(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    limit_spin_time();
    const sched_param parameters{.sched_priority = 1};
    if (::sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) ::_exit(kNotPermitted);
    work();
    ::_exit(EXIT_SUCCESS);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return status;
}

bool permitted(int status) { return !WIFEXITED(status) || WEXITSTATUS(status) != kNotPermitted; }

TEST(SpinLimit, EndsAProcessThatSpinsWithRealTimeScheduling) {
  const int status = status_after([] { compute_for(4 * kLongestSpin); });
  if (!permitted(status)) GTEST_SKIP() << "SCHED_FIFO is not permitted";
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGXCPU);
}

TEST(SpinLimit, PermitsTheSameWorkWithWaitsInBetween) {
  const int status = status_after([] {
    for (int tick = 0; tick < 8; ++tick) {
      compute_for(kLongestSpin / 2);
      const timespec pause{.tv_sec = 0, .tv_nsec = 1'000'000};
      ::nanosleep(&pause, nullptr);
    }
  });
  if (!permitted(status)) GTEST_SKIP() << "SCHED_FIFO is not permitted";
  ASSERT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), EXIT_SUCCESS);
}

}  // namespace
}  // namespace crane::runtime
