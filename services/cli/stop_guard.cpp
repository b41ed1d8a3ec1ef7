#include "cli/stop_guard.hpp"

#include <unistd.h>

#include <csignal>

#include "crane/runtime/process.hpp"
#include "crane/runtime/signals.hpp"

namespace crane::cli {
namespace {

/// Blocks all signals in this thread, so that the main thread executes the handlers and its waits end.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

StopGuard::StopGuard() {
  const SignalsBlocked blocked;  // the new thread inherits the mask
  thread_ = std::jthread{[this](const std::stop_token& done) { watch(done); }};
}

void StopGuard::watch(const std::stop_token& done) const {
  constexpr std::chrono::milliseconds kPeriod{50};
  std::chrono::milliseconds unanswered{0}, unfinished{0};
  while (!done.stop_requested()) {
    std::this_thread::sleep_for(kPeriod);
    if (stopping_)
      unfinished += kPeriod;
    else if (runtime::stop_requested())
      unanswered += kPeriod;
    if (unanswered > kPatience || unfinished > kStopPatience) ::_exit(runtime::kExitFailed);
  }
}

}  // namespace crane::cli
