/// crane move: new targets for one or more axes.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/move_follower.hpp"
#include "cli/number_range.hpp"
#include "cli/operator_request.hpp"
#include "cli/units.hpp"
#include "commands.hpp"

namespace crane::cli {
namespace {

struct MoveOptions {
  stack::OperatorRequest wanted{.kind = crane_REQUEST_MOVE};
  bool wait = false;
  double timeout_s = 120;
  runtime::BusOptions bus = tool_bus();
};

int move(const MoveOptions& options) {
  auto bus = open_bus(options.bus, crane_SOURCE_OPERATOR);
  MoveFollower follower{bus};
  const auto answer = ask(bus, options.wanted);
  if (!answer.accepted || !options.wait) return report("move", answer);
  follower.follow(answer.id, options.timeout_s);
  std::cout << "move: done\n";
  return runtime::kExitDone;
}

void add_axis(CLI::App& command, stack::OperatorRequest& wanted, std::size_t axis, const std::string& name,
              Dimension dimension, const std::string& help) {
  command
      .add_option_function<std::string>(
          name,
          [&wanted, axis, name, dimension](const std::string& text) {
            try {
              wanted.target[axis] = parse_quantity(text, dimension);
              wanted.selected[axis] = true;
            } catch (const UnitError& error) {
              throw CLI::ValidationError(name, error.what());
            }
          },
          help)
      ->type_name(dimension == Dimension::length ? "LENGTH" : "ANGLE");
}

}  // namespace

void add_move(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<MoveOptions>();
  auto* command = app.add_subcommand("move", "Move axes to new targets; the other axes keep their targets");
  add_axis(*command, options->wanted, 0, "--trolley", Dimension::length,
           "trolley position on the jib: 1.05, 105cm");
  add_axis(*command, options->wanted, 1, "--slew", Dimension::angle, "slew angle: 1.57, 90deg");
  add_axis(*command, options->wanted, 2, "--hoist", Dimension::length, "cable length: 0.8, 80cm");
  command->add_flag("--wait", options->wait,
                    "wait until the crane is in HOLD again, or print the reason of a failure");
  command->add_option("--timeout", options->timeout_s, "longest wait of --wait in s")
      ->check(number_in(kShortestWait_s, kLongestWait_s))
      ->capture_default_str();
  runtime::add_bus_options(*command, options->bus);
  command->footer(
      "Example: crane move --trolley 1.05 --slew 90deg --wait\n"
      "A plain number is in m or rad. The crane must be armed (HOLD, or RUN to change the target).");
  command->callback([options, &chosen] {
    const auto& axes = options->wanted.selected;
    if (!axes[0] && !axes[1] && !axes[2])
      throw CLI::ValidationError("move", "give at least one of --trolley, --slew, --hoist");
    chosen = [options] { return move(*options); };
  });
}

}  // namespace crane::cli
