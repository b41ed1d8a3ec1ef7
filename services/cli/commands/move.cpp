/// crane move: new targets for one or more axes.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/operator_request.hpp"
#include "cli/units.hpp"
#include "commands.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::cli {
namespace {

struct MoveOptions {
  stack::Wish wish{.kind = crane_REQUEST_MOVE};
  bool wait = false;
  double timeout_s = 120;
  runtime::BusOptions bus = tool_bus();
};

/// Follows the supervisor until the move is over. @throws std::runtime_error when it does not end well
void follow(bus::Bus& bus, bus::Subscriber<msg::SupervisorStatus>& statuses, std::uint64_t id,
            double timeout_s) {
  constexpr int kSettled = 50;  // ticks in HOLD, one after the other: a single one may lie between two in RUN
  bool taken_up = false;
  int held = 0;
  wait_until(bus, timeout_s, [&] {
    while (const auto status = statuses.take()) {
      if (status->request_id != id) {
        if (taken_up) throw std::runtime_error("move: replaced by a later one");
        continue;  // sent before the move was accepted
      }
      taken_up = true;
      held = status->state == crane_STATE_HOLD ? held + 1 : 0;
      if (held >= kSettled) return true;
      if (status->state == crane_STATE_HOLD || status->state == crane_STATE_RUN) continue;
      const auto cause = static_cast<supervisor::Cause>(status->cause);
      throw std::runtime_error(std::string{"move: stopped in "} +
                               supervisor::name_of(static_cast<supervisor::State>(status->state)) +
                               " because of " + supervisor::name_of(cause) + ": " +
                               supervisor::remedy_for(cause));
    }
    return false;
  });
  if (held < kSettled)
    throw std::runtime_error(runtime::stop_requested()
                                 ? "move: no longer waited for; the crane goes on"
                                 : "move: not at the target in time; the crane goes on");
}

int move(const MoveOptions& options) {
  auto bus = open_bus(options.bus, crane_SOURCE_OPERATOR);
  auto statuses = bus.subscriber(topics::supervisor);
  const auto answer = ask(bus, options.wish);
  if (!answer.accepted || !options.wait) return report("move", answer);
  follow(bus, statuses, answer.id, options.timeout_s);
  std::cout << "move: done\n";
  return runtime::kExitDone;
}

void add_axis(CLI::App& command, stack::Wish& wish, std::size_t axis, const std::string& name,
              Dimension dimension, const std::string& help) {
  command
      .add_option_function<std::string>(
          name,
          [&wish, axis, name, dimension](const std::string& text) {
            try {
              wish.target[axis] = parse_quantity(text, dimension);
              wish.selected[axis] = true;
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
  auto* command = app.add_subcommand("move", "Move to new targets; axes not named stay where they are");
  add_axis(*command, options->wish, 0, "--trolley", Dimension::length,
           "trolley position on the jib: 1.05, 105cm");
  add_axis(*command, options->wish, 1, "--slew", Dimension::angle, "slew angle: 1.57, 90deg");
  add_axis(*command, options->wish, 2, "--hoist", Dimension::length, "cable length: 0.8, 80cm");
  command->add_flag("--wait", options->wait, "return when the crane holds again, or with the reason why not");
  command->add_option("--timeout", options->timeout_s, "longest wait of --wait in s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  runtime::add_bus_options(*command, options->bus);
  command->footer(
      "Example: crane move --trolley 1.05 --slew 90deg --wait\n"
      "A plain number is in m or rad. The crane must be armed (HOLD, or RUN to change the target).");
  command->callback([options, &chosen] {
    const auto& axes = options->wish.selected;
    if (!axes[0] && !axes[1] && !axes[2])
      throw CLI::ValidationError("move", "name at least one of --trolley, --slew, --hoist");
    chosen = [options] { return move(*options); };
  });
}

}  // namespace crane::cli
