/// A process whose memory grows ends by a failed allocation; a process that allocates and frees the same
/// amount continues.
#include "crane/runtime/memory_limit.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <vector>

namespace crane::runtime {
namespace {

constexpr std::size_t kPiece_bytes = std::size_t{1} << 20U;
constexpr int kOutOfMemory = 7;

/// Runs `work` in a child process with the limit. @return exit status
int exit_after(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    limit_memory_growth();
    try {
      work();
    } catch (const std::bad_alloc&) {
      ::_exit(kOutOfMemory);
    }
    ::_exit(EXIT_SUCCESS);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// Allocates `bytes` in total, at most `most_held` at the same time.
void allocate(std::size_t bytes, std::size_t most_held) {
  std::vector<std::unique_ptr<char[]>> held(most_held);
  for (std::size_t i = 0; i < bytes / kPiece_bytes; ++i)
    held[i % most_held] = std::make_unique<char[]>(kPiece_bytes);
}

TEST(MemoryLimit, EndsAProcessThatGrows) {
  constexpr auto kTwice = 2 * kMostGrowth_bytes;
  EXPECT_EQ(exit_after([] { allocate(kTwice, kTwice / kPiece_bytes); }), kOutOfMemory);
}

TEST(MemoryLimit, PermitsHalfOfTheGrowthAndAnyNumberOfFreedAllocations) {
  EXPECT_EQ(exit_after([] { allocate(4 * kMostGrowth_bytes, kMostGrowth_bytes / 2 / kPiece_bytes); }),
            EXIT_SUCCESS);
}

TEST(MemoryLimit, KeepsALowerLimitOfTheAdministrator) {
  EXPECT_EQ(exit_after([] {
              const rlimit lower{.rlim_cur = kMostGrowth_bytes / 4, .rlim_max = RLIM_INFINITY};
              if (::setrlimit(RLIMIT_DATA, &lower) != 0) ::_exit(EXIT_FAILURE);
              limit_memory_growth();
              rlimit limit{};
              ::getrlimit(RLIMIT_DATA, &limit);
              ::_exit(limit.rlim_cur == lower.rlim_cur ? EXIT_SUCCESS : EXIT_FAILURE);
            }),
            EXIT_SUCCESS);
}

}  // namespace
}  // namespace crane::runtime
