#pragma once
/// A program of the project, started as by a user: output, exit code, child processes.
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace crane::system_test {

class ProgramRun {
 public:
  ProgramRun(const std::filesystem::path& program, const std::vector<std::string>& arguments);
  ~ProgramRun();  ///< ends it
  ProgramRun(const ProgramRun&) = delete;
  ProgramRun& operator=(const ProgramRun&) = delete;

  /// Waits for the end of the program. @return exit code, 128 + signal; nothing after `patience`
  std::optional<int> wait(std::chrono::milliseconds patience);
  /// Waits for `text` on standard output. @return false when the program ended or `patience` passed
  bool wait_for(const std::string& text, std::chrono::milliseconds patience);
  /// Like wait_for(), but reads standard error.
  bool wait_for_error(const std::string& text, std::chrono::milliseconds patience);
  void send(int signal) const;

  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] const std::string& output() const { return output_; }
  [[nodiscard]] const std::string& errors() const { return errors_; }

 private:
  /// Reads until new output arrives. @return false after the time, or at the end of the output
  bool read_some(std::chrono::steady_clock::time_point give_up);

  pid_t pid_ = 0;
  int output_pipe_ = -1, error_pipe_ = -1;
  std::string output_, errors_;
};

/// Runs the program to its end.
struct Ended {
  int exit_code = -1;  ///< -1: it did not end
  std::string output, errors;
};
[[nodiscard]] Ended run_program(const std::filesystem::path& program,
                                const std::vector<std::string>& arguments);

/// Processes with `text` on their command line, without this process.
[[nodiscard]] std::vector<pid_t> processes_with(const std::string& text);
/// Waits until all of `pids` have ended. @return false after `patience`
[[nodiscard]] bool wait_for_end(const std::vector<pid_t>& pids, std::chrono::milliseconds patience);

}  // namespace crane::system_test
