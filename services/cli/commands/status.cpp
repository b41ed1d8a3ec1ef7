/// crane status: processes, state of the crane, cause and remedy.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/number_range.hpp"
#include "cli/snapshot.hpp"
#include "cli/tool_bus.hpp"
#include "commands.hpp"

namespace crane::cli {
namespace {

constexpr const char* kInsecure =
    "INSECURE: every host that reaches this network can command the crane; crane keys make DIR, then crane "
    "up --secure "
    "DIR\n\n";

struct StatusOptions {
  bool json = false;
  double timeout_s = 3;
  runtime::BusOptions bus = tool_bus();
};

int status(const StatusOptions& options) {
  auto bus = open_bus(options.bus);
  const auto snapshot = listen(bus, options.timeout_s);
  if (snapshot.empty()) throw std::runtime_error("no sample received" + where_and_remedy(bus));
  // a bus without keys would not receive the samples of a secured stack
  const bool insecure = runtime::is_insecure(bus.options());
  if (options.json) {
    auto json = to_json(snapshot);
    json["insecure"] = insecure;
    std::cout << json.dump(2) << '\n';
  } else {
    if (insecure) std::cout << kInsecure;
    print(std::cout, snapshot);
  }
  return runtime::kExitDone;
}

}  // namespace

void add_status(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<StatusOptions>();
  auto* command =
      app.add_subcommand("status", "Show the processes, the safety state with its remedy, and the axes");
  command->add_flag("--json", options->json, "print one JSON object");
  command->add_option("--timeout", options->timeout_s, "longest wait for all processes of the loop in s")
      ->check(positive_number())
      ->capture_default_str();
  runtime::add_bus_options(*command, options->bus);
  command->footer("Example: crane status --json | jq .supervisor.state");
  command->callback([options, &chosen] { chosen = [options] { return status(*options); }; });
}

}  // namespace crane::cli
