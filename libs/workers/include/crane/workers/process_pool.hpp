#pragma once
/// Runs tasks 0 ... count - 1, each in a separate process (fork). Tasks share no memory: a crash of one task
/// does not affect the others. At most `at_a_time` processes run at the same time; the next task starts when
/// a process has ended. An endless task occupies its process until `cancelled` returns true. Call run() while
/// the calling process has one thread: fork copies the calling thread only.
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace crane::workers {

/// Sends records of a task to the parent process. A child process of the task may also send while the task
/// waits for this child.
class Outbox {
 public:
  explicit Outbox(int descriptor) : descriptor_{descriptor} {}
  /// Ends the calling process when the parent process has ended.
  void send(std::string_view record) const;

 private:
  int descriptor_;
};

struct Tasks {
  std::size_t count = 0;
  std::size_t at_a_time = 1;  ///< >= 1
  /// Called in the process of the task. An exception ends the process with exit code 1.
  std::function<void(std::size_t task, const Outbox& outbox)> work;
  /// Called in the parent process for each record; records of one task arrive in the order of sending.
  std::function<void(std::size_t task, std::string record)> take;
  /// Called in the parent process when the process of the task has ended, after its last record. May be
  /// empty.
  std::function<void(std::size_t task, const std::string& failure)> ended{};
  /// Called in the parent process after each event. true: run() kills the running tasks and returns. May be
  /// empty.
  std::function<bool()> cancelled{};
};

/// `failure` of Tasks::ended is empty after exit code 0, otherwise "exit code 1" or "signal 11".
/// An exception that leaves this function kills the running tasks.
/// @throws std::system_error when a process cannot be started
/// @throws the exceptions of take and ended
void run(const Tasks& tasks);

/// A Tasks::ended for tasks that must not fail. @throws std::runtime_error for a failure
void require_success(std::size_t task, const std::string& failure);

/// Number of processors that this process may use, at least 1.
[[nodiscard]] unsigned processors();

}  // namespace crane::workers
