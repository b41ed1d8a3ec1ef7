#pragma once
/// The processes of a stack as child processes of one command. The kernel ends them when the parent ends.
#include <sys/types.h>
#include <algorithm>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace crane::stack {

/// A child process that has ended by itself.
struct Ended {
  std::string name;
  std::string how;     ///< "exit code 2", "signal 9 (Killed)"
  int exit_code = -1;  ///< -1: a signal
};

class ChildProcesses {
 public:
  ChildProcesses() = default;
  ~ChildProcesses() { stop(); }
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;

  /// Starts `program` from the directory of the running executable. @throws std::runtime_error
  /// @param inherited  the only descriptor that the child inherits besides the standard ones; -1: none
  void start(const std::string& name, const std::string& program, const std::vector<std::string>& arguments,
             int inherited = -1);
  /// The first child that has ended; nothing while all children run.
  [[nodiscard]] std::optional<Ended> ended();
  /// Sends SIGTERM to all children in the order of their start, and SIGKILL to those that still run after
  /// `patience`. Waits for all.
  void stop(std::chrono::milliseconds patience = std::chrono::milliseconds{3000}) noexcept;
  [[nodiscard]] std::optional<pid_t> pid_of(const std::string& name) const;
  [[nodiscard]] bool contains(pid_t pid) const {
    return std::ranges::find(children_, pid, &Child::pid) != children_.end();
  }

 private:
  struct Child {
    std::string name;
    pid_t pid = 0;
    bool running = true;
  };
  std::vector<Child> children_;
};

/// Directory of the running executable and of the other programs.
[[nodiscard]] std::filesystem::path program_directory();

}  // namespace crane::stack
