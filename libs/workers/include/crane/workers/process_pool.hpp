#pragma once
/// Runs tasks 0 ... count - 1, each in a separate process (fork). Tasks share no memory; a crash or an
/// endless loop affects its own task only. The next task starts when a process has ended. Call it while this
/// process has one thread: a fork copies the calling thread only.
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace crane::workers {

/// Sends records of a task to the parent process. A process that the task forks may also send, while the task
/// waits for it.
class Outbox {
 public:
  explicit Outbox(int descriptor) : descriptor_{descriptor} {}
  /// Ends the process when the parent has ended.
  void send(std::string_view record) const;

 private:
  int descriptor_;
};

struct Tasks {
  std::size_t count = 0;
  std::size_t at_a_time = 1;  ///< >= 1
  /// In the process of the task. An exception ends the process with exit code 1.
  std::function<void(std::size_t task, const Outbox& outbox)> work;
  /// In this process, for each record as it arrives; records of one task arrive in their order.
  std::function<void(std::size_t task, std::string record)> take;
  /// In this process, when the process of the task has ended, after its last record. May be empty.
  std::function<void(std::size_t task, const std::string& failure)> ended{};
  /// true: kill the running tasks and return. Called after each event. May be empty.
  std::function<bool()> cancelled{};
};

/// `failure` of Tasks::ended is empty after exit code 0, otherwise "exit code 1" or "signal 11".
/// @throws std::system_error when a process cannot be started, and exceptions of take and ended; running
/// tasks
///   are killed first
void run(const Tasks& tasks);

/// A Tasks::ended for tasks that must not fail. @throws std::runtime_error for a failure
void require_success(std::size_t task, const std::string& failure);

/// Number of processors that this process may use, at least 1.
[[nodiscard]] unsigned processors();

}  // namespace crane::workers
