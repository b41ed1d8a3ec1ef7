/// crane jog: drives the axes by speed, from the keyboard, with a gamepad, or for a given time.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "cli/inching.hpp"
#include "cli/number_range.hpp"
#include "cli/stick_session.hpp"
#include "cli/units.hpp"
#include "commands.hpp"
#include "crane/plant/coordinates.hpp"
#include "jog.hpp"

namespace crane::cli {
namespace {

struct JogOptions {
  Deflection deflection{};
  std::array<bool, 3> selected{};
  double for_s = 1;
  StickOptions stick;
  std::optional<std::string> gamepad;                ///< device; "": the only gamepad; nothing: no gamepad
  std::vector<std::string> axes{"trolley", "slew"};  ///< axes of keyboard and gamepad
};

void print_axes(const char* what, const Measured& measured) {
  std::printf("%-12s trolley %+.3f m, slew %+.2f deg, hoist %+.3f m, largest swing %.2f deg\n", what,
              measured.to[0] - measured.from[0], (measured.to[1] - measured.from[1]) * 180 / std::numbers::pi,
              measured.to[2] - measured.from[2], measured.largest_swing_rad * 180 / std::numbers::pi);
}

int scripted(const JogOptions& options) {
  auto deflection = options.deflection;
  if (options.stick.micro)
    for (double& share : deflection) share *= kMicroSpeed;
  auto bus = open_bus(options.stick.bus, crane_SOURCE_OPERATOR);
  StickSession session{bus};
  if (const auto answer = session.begin(options.selected); !answer.accepted) return report("jog", answer);
  session.measure();
  const bool stopped_early = session.drive(
      options.for_s, true, [&deflection] { return deflection; }, [&session] { return session.in_hold(); });
  const bool interrupted = runtime::stop_requested();
  const Measured driven = session.measured();
  session.measure();
  session.release(options.stick.timeout_s);
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

/// @throws CLI::ValidationError
double step_of(const std::string& text) {
  try {
    const double step_m = parse_quantity(text, Dimension::length);
    if (step_m >= kSmallestStep_m && step_m <= kLargestStep_m) return step_m;
  } catch (const UnitError& error) {
    throw CLI::ValidationError("--step", error.what());
  }
  throw CLI::ValidationError("--step", text + ": must lie in 0.5 mm to 50 mm");
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

/// Options of a deflection for a given time, without keyboard or gamepad.
void add_scripted_options(CLI::App& command, JogOptions& options) {
  add_axis(command, options, 0, "--trolley", "share of the largest speed, -1 to 1; positive: outwards");
  add_axis(command, options, 1, "--slew", "share of the largest speed, -1 to 1");
  add_axis(command, options, 2, "--hoist", "share of the largest speed, -1 to 1; positive: down");
  command
      .add_option(
          "--for", options.for_s,
          "duration of the deflection in s; the supervisor releases a stick that is deflected for 60 s")
      ->check(number_in(0.02, 50.0))
      ->capture_default_str();
}

void add_stick_options(CLI::App& command, JogOptions& options) {
  command.add_flag("--micro", options.stick.micro,
                   "begin at micro-speed, a tenth of the speed; keyboard: the key m ends micro-speed");
  command.add_flag("--inch", options.stick.inching, "keyboard: begin with inching; the key i ends inching");
  command
      .add_option_function<std::string>(
          "--step", [&options](const std::string& text) { options.stick.step_m = step_of(text); },
          "step of inching, 0.5 mm to 50 mm; slew axis: arc at the radius of the trolley (default: 2mm)")
      ->type_name("LENGTH");
  command
      .add_option("--axes", options.axes,
                  "axes of keyboard and gamepad; with the hoist, all stops take longer (docs/jog.md)")
      ->check(CLI::IsMember(plant::drive_names()))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--gamepad", [&options](const std::string& device) { options.gamepad = device; },
          "use a gamepad as the stick; without DEVICE: the only gamepad in /dev/input")
      ->expected(0, 1)
      ->default_str("")
      ->type_name("DEVICE");
  command.add_option("--timeout", options.stick.timeout_s, "longest wait for rest in s")
      ->check(number_in(kShortestWait_s, kLongestWait_s))
      ->capture_default_str();
}

constexpr const char* kJogNotes =
    "Examples: crane jog                                         # keyboard: trolley and slew\n"
    "          crane jog --inch --step 1mm                      # each key press is one step\n"
    "          crane jog --trolley 0.5 --slew -0.2 --for 2      # deflects, releases, prints travel and "
    "swing\n"
    "          crane jog --gamepad /dev/input/event5            # the levers act while the left shoulder "
    "button is held\n"
    "The crane must be in HOLD. Keys: up/down trolley, left/right slew, PgUp/PgDn hoist; with shift, or\n"
    "after m, at micro-speed; space releases the stick; q ends the program. A terminal reports no release\n"
    "of a key: a key acts for 0.6 s, and for 0.15 s after each repetition by the keyboard. Keys older\n"
    "than 0.6 s (suspended program, slow connection) move nothing; space and q always act. The stick is\n"
    "released after ten seconds without an arrow or page key.\n"
    "The key i turns inching on and off: each key press moves one axis by a step; a key that is held down\n"
    "causes one step. The key r releases the stick and moves the axes back to the stop point, where the\n"
    "stick was last released.\n"
    "Steps and returns are moves: the supervisor checks them like `crane move`. During a move, space, q,\n"
    "Ctrl-C and a closed terminal stop the crane, which then locks.\n"
    "The crane stops when this program ends or sends nothing for 0.1 s, and when the stick has been\n"
    "deflected for a minute without a break. After such a stop, release the keys first. Exception: if\n"
    "SIGKILL ends this program during a step or a return, the crane continues to the target of the move.";

}  // namespace

void add_jog(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<JogOptions>();
  auto* command =
      app.add_subcommand("jog", "Drive the axes by speed; input shaping reduces the swing of the load");
  add_scripted_options(*command, *options);
  add_stick_options(*command, *options);
  runtime::add_bus_options(*command, options->stick.bus);
  command->footer(kJogNotes);
  command->callback([options, command, &chosen] {
    const bool any = options->selected != std::array<bool, 3>{};
    for (std::size_t i = 0; i < options->stick.selected.size(); ++i)
      options->stick.selected[i] =
          std::ranges::find(options->axes, plant::kCoordinates[i].name) != options->axes.end();
    if (options->gamepad && (any || options->stick.inching))
      throw CLI::ValidationError("--gamepad", "excludes --trolley, --slew, --hoist and --inch");
    for (const char* of_keys : {"--inch", "--step", "--axes"})
      if (any && command->count(of_keys) > 0)
        throw CLI::ValidationError(of_keys,
                                   "excludes --trolley, --slew and --hoist, which deflect the stick "
                                   "for a time (an inching step without keys: crane move)");
    chosen = [options, any] {
      if (options->gamepad) return jog_by_gamepad(*options->gamepad, options->stick);
      return any ? scripted(*options) : jog_by_keyboard(options->stick);
    };
  });
}

}  // namespace crane::cli
