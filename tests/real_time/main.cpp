/// main() of the real-time tests. The tests run in a child; a TimerWitness runs beside it. A test that fails
/// is repeated only when the witness proves that the computer paused, at most kMostAttempts times in all;
/// pauses and attempts are printed. Every other failure is final.
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "timer_witness.hpp"

extern char** environ;

namespace {

using crane::real_time_test::TimerWitness;

constexpr const char* kChild = "CRANE_BESIDE_A_TIMER_WITNESS";
constexpr int kMostAttempts = 3;

/// @return exit code, 128 + signal
int run_in_child(char** argv) {
  ::setenv(kChild, "1", 1);
  pid_t child = 0;
  if (::posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, argv, environ) != 0) return 127;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int run_beside_witness(char** argv) {
  TimerWitness witness;
  for (int attempt = 1;; ++attempt) {
    (void)witness.take();
    const int code = run_in_child(argv);
    const auto seen = witness.take();
    if (code == 0 && attempt == 1) return 0;
    const double latest_ms = static_cast<double>(seen.latest_ns) * 1e-6;
    std::cout << "attempt " << attempt << (code == 0 ? " passed" : " failed")
              << "; bare timer: " << seen.pauses << " pauses, latest wake-up " << latest_ms << " ms"
              << (witness.has_priority() ? "" : ", without real-time priority") << std::endl;
    if (code == 0 || seen.pauses == 0 || attempt == kMostAttempts) return code;
  }
}

bool lists_tests(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::string_view{argv[i]}.starts_with("--gtest_list_tests")) return true;
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (std::getenv(kChild) == nullptr && !lists_tests(argc, argv)) return run_beside_witness(argv);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
