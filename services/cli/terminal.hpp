#pragma once
/// Output on the terminal of the command: views that refresh in place, and lines that never wait.
#include <termios.h>

#include <optional>
#include <string>
#include <string_view>

namespace crane::cli {

struct TerminalSize {
  int columns = 80, rows = 24;
};
/// True: standard output is a terminal.
[[nodiscard]] bool output_is_terminal();
/// Size of the terminal; 80 x 24 when standard output is not a terminal.
[[nodiscard]] TerminalSize terminal_size();

/// Writes a line of at most 512 bytes; discards the line while the output blocks (a full pipe, a paused
/// terminal), so that a program that moves the crane continues to read the keys that stop the crane.
void print_unless_blocked(int descriptor, std::string_view line);

/// Characters of a UTF-8 text, each one column wide.
[[nodiscard]] std::size_t width_of(std::string_view text);
/// The first `columns` characters.
[[nodiscard]] std::string_view cut(std::string_view text, std::size_t columns);
/// The lines of `text` that fit the terminal. Each line is cut to the columns; the last line states the
/// number of omitted lines.
[[nodiscard]] std::string fitted(std::string_view text, const TerminalSize& size);

/// The alternate screen of the terminal, without cursor and echo. The destructor restores the terminal.
class Screen {
 public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Replaces the shown text by the lines of `text` that fit.
  void show(std::string_view text);
  /// True when the key q has been pressed since the start. Does not wait.
  [[nodiscard]] bool quit_requested();

 private:
  std::optional<termios> settings_;  ///< to restore; nothing: standard input is not a terminal
  bool quit_ = false;
};

}  // namespace crane::cli
