#pragma once
/// A program of the project on a separate terminal, with the output that a user sees.
#include <sys/types.h>
#include <termios.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace crane::system_test {

class TerminalRun {
 public:
  TerminalRun(const std::filesystem::path& program, const std::vector<std::string>& arguments, int columns,
              int rows);
  ~TerminalRun();  ///< ends it
  TerminalRun(const TerminalRun&) = delete;
  TerminalRun& operator=(const TerminalRun&) = delete;

  /// Waits for `text` on the terminal. @return false when the program ended or `patience` passed
  bool wait_for(const std::string& text, std::chrono::milliseconds patience);
  /// Waits for the end. @return exit code, 128 + signal; nothing after `patience`
  std::optional<int> wait(std::chrono::milliseconds patience);
  void type(const std::string& keys) const;
  void send(int signal) const;
  void resize(int columns, int rows) const;

  [[nodiscard]] termios settings() const;  ///< of the terminal
  [[nodiscard]] const std::string& output() const { return output_; }
  void forget() { output_.clear(); }

 private:
  bool read_some(std::chrono::steady_clock::time_point give_up);

  pid_t pid_ = 0;
  int terminal_ = -1, other_end_ = -1;
  std::string output_;
};

}  // namespace crane::system_test
