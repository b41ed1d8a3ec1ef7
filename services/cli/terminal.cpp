#include "cli/terminal.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <iostream>
#include <vector>

namespace crane::cli {
namespace {

constexpr std::string_view kEnter = "\x1b[?1049h\x1b[?25l", kLeave = "\x1b[?25h\x1b[?1049l";
constexpr std::string_view kHome = "\x1b[H", kClearLine = "\x1b[K", kClearBelow = "\x1b[J";

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace

bool output_is_terminal() { return ::isatty(STDOUT_FILENO) != 0; }

TerminalSize terminal_size() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return {};
  return {size.ws_col, size.ws_row};
}

void print_unless_blocked(int descriptor, std::string_view line) {
  pollfd output{descriptor, POLLOUT, 0};
  if (::poll(&output, 1, 0) <= 0 || (output.revents & POLLOUT) == 0) return;
  [[maybe_unused]] const auto written = ::write(descriptor, line.data(), line.size());
}

std::size_t width_of(std::string_view text) {
  std::size_t width = 0;
  for (const char c : text) width += continues_character(c) ? 0 : 1;
  return width;
}

std::string_view cut(std::string_view text, std::size_t columns) {
  std::size_t end = 0;
  for (std::size_t width = 0; end < text.size(); ++end)
    if (!continues_character(text[end]) && ++width > columns) break;
  return text.substr(0, end);
}

std::string fitted(std::string_view text, const TerminalSize& size) {
  const auto lines = lines_of(text);
  const auto rows = static_cast<std::size_t>(size.rows), columns = static_cast<std::size_t>(size.columns);
  std::size_t shown = lines.size();
  if (lines.size() > rows) shown = rows > 0 ? rows - 1 : 0;
  std::string result;
  for (std::size_t i = 0; i < shown; ++i) result.append(cut(lines[i], columns)).append("\n");
  if (shown < lines.size() && rows > 0)
    result
        .append(cut(std::to_string(lines.size() - shown) + " more lines: the terminal is too small", columns))
        .append("\n");
  return result;
}

Screen::Screen() {
  if (termios now{}; ::tcgetattr(STDIN_FILENO, &now) == 0) {
    settings_ = now;
    now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    now.c_cc[VMIN] = now.c_cc[VTIME] = 0;
    // Switches off Ctrl-Z, because the shell would inherit the settings of the view.
    now.c_cc[VSUSP] = _POSIX_VDISABLE;
    ::tcsetattr(STDIN_FILENO, TCSANOW, &now);
  }
  std::cout << kEnter << std::flush;
}

Screen::~Screen() {
  std::cout << kLeave << std::flush;
  if (settings_) ::tcsetattr(STDIN_FILENO, TCSANOW, &*settings_);
}

void Screen::show(std::string_view text) {
  const auto picture = fitted(text, terminal_size());
  std::string output{kHome};
  const auto lines = lines_of(picture);
  for (std::size_t i = 0; i < lines.size(); ++i)
    output.append(i > 0 ? "\r\n" : "").append(lines[i]).append(kClearLine);
  output += kClearBelow;
  std::cout << output << std::flush;
}

bool Screen::quit_requested() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  while (settings_ && ::poll(&input, 1, 0) > 0) {
    std::array<char, 64> keys{};
    const auto n = ::read(STDIN_FILENO, keys.data(), keys.size());
    if (n <= 0) break;
    for (const char key : std::string_view{keys.data(), static_cast<std::size_t>(n)})
      quit_ = quit_ || key == 'q' || key == 'Q';
  }
  return quit_;
}

}  // namespace crane::cli
