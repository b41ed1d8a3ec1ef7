#pragma once
/// Ends a program that starts a stack and cannot obey a stop signal: its main thread waits, for example for
/// the reader of its output (a full pipe, a terminal that has stopped), a disk or the service manager. The
/// kernel then sends SIGTERM to the processes of the stack (ChildProcesses), and the bridge closes the
/// brakes.
#include <atomic>
#include <chrono>
#include <thread>

namespace crane::cli {

class StopGuard {
 public:
  /// Longest time from the stop signal to stopping(). The main thread looks for the signal every 50 ms.
  static constexpr std::chrono::milliseconds kPatience{500};
  /// Longest time from stopping() to the end of this object: the stop of the child processes takes at most 3
  /// s.
  static constexpr std::chrono::seconds kStopPatience{10};

  StopGuard();
  /// The main thread begins to stop the stack.
  void stopping() { stopping_ = true; }

 private:
  void watch(const std::stop_token& done) const;
  std::atomic<bool> stopping_{false};
  std::jthread thread_;
};

}  // namespace crane::cli
