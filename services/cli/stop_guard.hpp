#pragma once
/// Ends a program that has started a stack when its main thread does not react to a stop signal, because it
/// is blocked by a full pipe, a paused terminal, a disk or the service manager. The kernel then sends SIGTERM
/// to the processes of the stack (ChildProcesses), and the bridge closes the brakes.
#include <atomic>
#include <chrono>
#include <thread>

namespace crane::cli {

class StopGuard {
 public:
  /// Longest time from the stop signal to stopping(). The main thread polls the signal every 50 ms.
  static constexpr std::chrono::milliseconds kPatience{500};
  /// Longest time from stopping() to the end of this object: the stop of the child processes takes at most 3
  /// s.
  static constexpr std::chrono::seconds kStopPatience{10};

  StopGuard();
  /// Call when the main thread begins to stop the stack.
  void stopping() { stopping_ = true; }

 private:
  void watch(const std::stop_token& done) const;
  std::atomic<bool> stopping_{false};
  std::jthread thread_;
};

}  // namespace crane::cli
