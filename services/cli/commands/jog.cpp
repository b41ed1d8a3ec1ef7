/// crane jog: drives the axes by speed, from the keyboard or for a given time.
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <numbers>

#include "cli/jog_session.hpp"
#include "cli/number_range.hpp"
#include "cli/stick_keys.hpp"
#include "commands.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::cli {
namespace {

struct JogOptions {
  Deflection deflection{};
  std::array<bool, 3> selected{};
  std::vector<std::string> axes{"trolley", "slew"};  ///< of the keyboard
  double for_s = 1;
  double timeout_s = 60;
  runtime::BusOptions bus = tool_bus();
};

double seconds() { return static_cast<double>(runtime::monotonic_ns()) / 1e9; }

void print_axes(const char* what, const Measured& measured) {
  std::printf("%-12s trolley %+.3f m, slew %+.2f deg, hoist %+.3f m, largest swing %.2f deg\n", what,
              measured.to[0] - measured.from[0], (measured.to[1] - measured.from[1]) * 180 / std::numbers::pi,
              measured.to[2] - measured.from[2], measured.largest_swing_rad * 180 / std::numbers::pi);
}

/// Sends the release until the crane is in HOLD.
void release(JogSession& session, double timeout_s) {
  if (!session.drive(
          timeout_s, false, [] { return std::nullopt; }, [&session] { return session.held(); }))
    throw std::runtime_error("jog: the crane was not at rest before the timeout: look at `crane status`");
}

int scripted(const JogOptions& options) {
  auto bus = open_bus(options.bus, crane_SOURCE_OPERATOR);
  JogSession session{bus};
  if (const auto answer = session.begin(options.selected); !answer.accepted) return report("jog", answer);
  session.measure();
  const bool stopped_early = session.drive(
      options.for_s, true, [&options] { return options.deflection; }, [&session] { return session.held(); });
  const bool interrupted = runtime::stop_requested();
  const Measured driven = session.measured();
  session.measure();
  release(session, options.timeout_s);
  const Measured stopped = session.measured();
  session.measure();
  constexpr double kResidual_s = 2;  // about one period of the load
  session.drive(
      kResidual_s, true, [] { return std::nullopt; }, [] { return false; });
  print_axes("deflected", driven);
  print_axes("stop", stopped);
  print_axes("at rest", session.measured());
  if (stopped_early)
    throw std::runtime_error(
        "jog: the supervisor has released the stick; `crane topic echo event` states why");
  if (interrupted)
    throw std::runtime_error("jog: interrupted; the stick was released and the crane is at rest");
  return runtime::kExitDone;
}

/// The terminal without echo and line editing. Ctrl-C still ends the program; suspending is off, because a
/// suspended program leaves the terminal as it is.
class RawTerminal {
 public:
  RawTerminal() {
    if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &before_) != 0)
      throw std::runtime_error(
          "jog: standard input is no terminal: give --trolley, --slew or --hoist, and --for");
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_cc[VSUSP] = raw.c_cc[VQUIT] = _POSIX_VDISABLE;
    raw.c_cc[VMIN] = raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~RawTerminal() { tcsetattr(STDIN_FILENO, TCSANOW, &before_); }
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  /// Bytes that have arrived; "q" when the terminal has closed.
  [[nodiscard]] static std::string read_keys() {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, 0) <= 0) return "";
    std::array<char, 64> bytes{};
    const auto count = read(STDIN_FILENO, bytes.data(), bytes.size());
    return count > 0 ? std::string(bytes.data(), static_cast<std::size_t>(count)) : "q";
  }

 private:
  termios before_{};
};

int keyboard(const JogOptions& options) {
  constexpr double kIdle_s = 10;  // without a key the session ends
  const RawTerminal terminal;
  auto bus = open_bus(options.bus, crane_SOURCE_OPERATOR);
  JogSession session{bus};
  StickKeys keys;
  std::array<bool, 3> selected{};
  for (std::size_t i = 0; i < selected.size(); ++i)
    selected[i] = std::ranges::find(options.axes, plant::kCoordinates[i].name) != options.axes.end();
  std::cout
      << "up/down: trolley, left/right: slew, PgUp/PgDn: hoist, shift or m: slow, space: release, q: end"
      << std::endl;
  const auto read_keys = [&keys] { keys.take(RawTerminal::read_keys(), seconds()); };
  while (!keys.quits() && !runtime::stop_requested()) {
    read_keys();
    if (keys.deflection(seconds()) == Deflection{}) {
      bus.wait(std::chrono::milliseconds{20});
      continue;
    }
    if (const auto answer = session.begin(selected); !answer.accepted) return report("jog", answer);
    const auto stick = [&]() -> std::optional<Deflection> {
      read_keys();
      if (keys.last_s() < 0 || seconds() - keys.last_s() > kIdle_s) return std::nullopt;
      return keys.deflection(seconds());
    };
    const auto over = [&] { return keys.quits() || session.held(); };
    session.drive(1e6, true, stick, over);
    release(session, options.timeout_s);
    std::cout << "at rest, HOLD" << std::endl;
  }
  return runtime::kExitDone;
}

void add_axis(CLI::App& command, JogOptions& options, std::size_t axis, const std::string& name,
              const std::string& help) {
  command
      .add_option_function<double>(
          name,
          [&options, axis](double share) {
            options.deflection[axis] = share;
            options.selected[axis] = true;
          },
          help)
      ->check(number_in(-1.0, 1.0))
      ->type_name("SHARE");
}

}  // namespace

void add_jog(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<JogOptions>();
  auto* command = app.add_subcommand("jog", "Drive the axes by speed; the load follows without swing");
  add_axis(*command, *options, 0, "--trolley", "share of the largest speed, -1 to 1; positive: outwards");
  add_axis(*command, *options, 1, "--slew", "share of the largest speed, -1 to 1");
  add_axis(*command, *options, 2, "--hoist", "share of the largest speed, -1 to 1; positive: down");
  command
      ->add_option("--for", options->for_s,
                   "time of the deflection in s, shorter than the minute of a stuck stick")
      ->check(number_in(0.02, 50.0))
      ->capture_default_str();
  command
      ->add_option("--axes", options->axes,
                   "axes of the keyboard; with the hoist, all stops take longer (docs/jog.md)")
      ->check(CLI::IsMember(plant::drive_names()))
      ->capture_default_str();
  command->add_option("--timeout", options->timeout_s, "longest wait for rest in s")
      ->check(number_in(kShortestWait_s, kLongestWait_s))
      ->capture_default_str();
  runtime::add_bus_options(*command, options->bus);
  command->footer(
      "Examples: crane jog                                         # keyboard: trolley and slew\n"
      "          crane jog --trolley 0.5 --slew -0.2 --for 2      # deflects, releases, prints travel and "
      "swing\n"
      "The crane must be in HOLD. Keys: up/down trolley, left/right slew, PgUp/PgDn hoist; with shift, or "
      "after\n"
      "m, a tenth of the speed; space releases; q ends. A terminal reports no release of a key: a key acts "
      "for\n"
      "0.6 s, and for 0.15 s after each repetition by the keyboard. Ten seconds without a key end the "
      "session.\n"
      "The crane stops when this program ends, sends nothing for 0.1 s, or deflects for a minute without a "
      "break;\n"
      "a deflection acts again after the keys have been released.");
  command->callback([options, &chosen] {
    const bool any = options->selected != std::array<bool, 3>{};
    chosen = [options, any] { return any ? scripted(*options) : keyboard(*options); };
  });
}

}  // namespace crane::cli
