#pragma once
/// Runs the component of a process: in the thread that delivers a sample, and in the main thread
/// after wake() and at the times that the component requests. A hand-over to another thread would
/// delay each sample by one wake-up.
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>

#include "crane/runtime/component.hpp"

namespace crane::runtime {

/// One thread at a time runs the component. While another thread runs the component, run() leaves a request
/// to that thread and returns: a receive thread may hold a lock of the vendor that the running thread needs,
/// and would deadlock if it waited. Only end() waits for another thread. The mutex is never held during a
/// poll.
class Turn {
 public:
  /// @param monotonic_ns  clock of Component::poll()
  explicit Turn(std::int64_t (*monotonic_ns)()) : monotonic_ns_{monotonic_ns} {}

  /// Polls `component` and lets run() poll it until end(). The main thread calls begin(), wait() and end().
  /// @param period_ns  interval of the times that the component requests; 0: irregular times or none
  void begin(Component& component, std::int64_t period_ns);
  /// Returns when no thread runs the component any more.
  void end();

  /// Polls the component until it has nothing to process. Without effect before begin() and after end(), and
  /// after an exception of the component, which wait() throws again.
  void run();

  /// Ends wait(), so that the main thread polls.
  void wake();

  /// Sleeps until wake(), or until the component must be polled without a new sample, at most `longest_ns`.
  /// @throws the exception that ended the component
  void wait(std::int64_t longest_ns);

 private:
  void poll();

  std::int64_t (*monotonic_ns_)();
  std::atomic<Component*> component_ = nullptr;
  /// calls of run() that the running thread serves; 0: no thread runs the component
  std::atomic<unsigned> requests_ = 0;
  std::int64_t period_ns_ = 0;

  std::mutex mutex_;  ///< protects the members below
  std::condition_variable changed_;
  std::int64_t wake_at_ns_ = kNever;  ///< Component::wake_at_ns() after the last poll
  std::int64_t due_ns_ = 0;           ///< last value of wake_at_ns_ that was not kNever
  std::int64_t sleeps_until_ns_ = 0;  ///< end of the sleep of the main thread
  bool woken_ = false;                ///< wake() was called since the last wait()
  std::exception_ptr failure_;
};

}  // namespace crane::runtime
