/// crane mode: shows or changes the operating mode.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/operator_request.hpp"
#include "cli/snapshot.hpp"
#include "commands.hpp"
#include "crane/supervisor/modes.hpp"

namespace crane::cli {
namespace {

struct ModeOptions {
  std::string name;  ///< empty: show the present mode
  runtime::BusOptions bus = tool_bus();
};

int show(const ModeOptions& options) {
  constexpr double kPatience_s = 5;
  auto bus = open_bus(options.bus);
  const auto snapshot = safety_state(bus, kPatience_s);
  if (!snapshot.supervisor) throw NoAnswer("no supervisor" + where_and_remedy(bus));
  print_mode(std::cout, *snapshot.supervisor);
  return runtime::kExitDone;
}

int change(const ModeOptions& options) {
  auto bus = open_bus(options.bus, crane_SOURCE_OPERATOR);
  const auto mode = static_cast<crane_OperatingMode>(*supervisor::find_mode(options.name));
  return report("mode", ask(bus, {.kind = crane_REQUEST_MODE, .mode = mode}));
}

std::string list_of_modes() {
  std::string list;
  for (std::size_t i = 0; i < supervisor::kModes; ++i) {
    const auto& rule = supervisor::rule_of(static_cast<supervisor::Mode>(i));
    constexpr std::size_t kWidth = 16;
    std::string name = rule.name;
    name.resize(kWidth, ' ');
    list += name + rule.purpose + '\n';
  }
  return list;
}

}  // namespace

void add_mode(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<ModeOptions>();
  auto* command = app.add_subcommand(
      "mode", "Show or change the operating mode: which requests may move the crane, and how fast");
  command->add_option("mode", options->name, supervisor::mode_names() + "; without it: show the mode")
      ->check([](const std::string& name) {
        return supervisor::find_mode(name) ? std::string{} : name + ": must be " + supervisor::mode_names();
      });
  runtime::add_bus_options(*command, options->bus);
  command->footer(
      list_of_modes() +
      "The supervisor starts in semi_automatic. It changes the mode only while the brakes are closed.\n"
      "docs/safety.md states the limits of each mode.\n"
      "Example: crane disarm && crane mode maintenance && crane reset && crane arm");
  command->callback([options, &chosen] {
    chosen = [options] { return options->name.empty() ? show(*options) : change(*options); };
  });
}

}  // namespace crane::cli
