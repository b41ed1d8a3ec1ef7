/// The keyboard of a terminal as the stick of `crane jog`.
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <iostream>
#include <sstream>

#include "cli/jog_loop.hpp"
#include "cli/stick_keys.hpp"
#include "cli/terminal.hpp"
#include "crane/runtime/node.hpp"
#include "jog.hpp"

namespace crane::cli {
namespace {

/// Switches off echo and line editing of the terminal; Ctrl-C still ends the program. Also switches off
/// Ctrl-Z, because the shell would inherit these settings, and Ctrl-S, because a paused terminal would show
/// no messages.
class RawTerminal {
 public:
  RawTerminal() {
    if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &before_) != 0)
      throw std::runtime_error(
          "jog: standard input is no terminal: give --trolley, --slew or --hoist, and --for");
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_iflag &= ~static_cast<tcflag_t>(IXON);
    raw.c_cc[VSUSP] = raw.c_cc[VQUIT] = _POSIX_VDISABLE;
    raw.c_cc[VMIN] = raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~RawTerminal() { tcsetattr(STDIN_FILENO, TCSANOW, &before_); }
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  /// @return all bytes that have arrived, and "q" at the end when the terminal has been closed. A stop key
  /// must not wait behind older keys. kMost ends the reading when the bytes arrive without end.
  [[nodiscard]] static std::string read_keys() {
    constexpr std::size_t kMost = 1 << 16;
    std::string keys;
    std::array<char, 4096> bytes{};
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    while (keys.size() < kMost && poll(&input, 1, 0) > 0) {
      const auto count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
      if (count <= 0) return keys + "q";
      keys.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return keys;
  }

 private:
  termios before_{};
};

class Keyboard : public OperatorStick {
 public:
  Keyboard(bool micro, bool inching, double step_m) : keys_{micro, inching}, step_m_{step_m} {}

  void read(double now_s) override {
    const bool micro = keys_.micro(), inching = keys_.inching();
    keys_.take_pass(RawTerminal::read_keys(), now_s);
    if (keys_.micro() != micro || keys_.inching() != inching) print_mode();
  }
  [[nodiscard]] std::optional<std::array<double, 3>> deflection(double now_s) const override {
    constexpr double kIdle_s = 10;  // time without a key after which the stick is released
    if (keys_.last_s() < 0 || now_s - keys_.last_s() > kIdle_s) return std::nullopt;
    return keys_.deflection(now_s);
  }
  std::optional<InchingStep> take_step() override { return keys_.take_step(); }
  bool take_return() override { return keys_.take_return(); }
  bool take_stop() override { return keys_.take_stop(); }
  [[nodiscard]] bool quits() const override { return keys_.quits(); }
  [[nodiscard]] const std::string& problem() const override { return problem_; }

  void print_mode() const {
    std::ostringstream line;
    if (keys_.inching())
      line << "inching: each key press moves one axis by " << step_m_ * 1e3 << " mm\n";
    else
      line << (keys_.micro() ? "micro-speed\n" : "full speed\n");
    print_unless_blocked(STDOUT_FILENO, line.str());
  }

 private:
  RawTerminal terminal_;
  StickKeys keys_;
  double step_m_;
  std::string problem_;  ///< always empty: a closed terminal acts like the key q
};

}  // namespace

int jog_by_keyboard(const StickOptions& options) {
  Keyboard keyboard{options.micro, options.inching, options.step_m};
  auto bus = open_bus(options.bus, crane_SOURCE_OPERATOR);
  JogLoop loop{bus, keyboard, {options.selected, options.step_m, options.timeout_s}};
  keyboard.read(static_cast<double>(runtime::monotonic_ns()) /
                1e9);  // keys that were typed before the next line appears move nothing
  std::cout << "up/down: trolley, left/right: slew, PgUp/PgDn: hoist, shift or m: micro-speed, i: inching, "
               "space: release,\nr: return to the stop point, q: end"
            << std::endl;
  keyboard.print_mode();
  return loop.run();
}

}  // namespace crane::cli
