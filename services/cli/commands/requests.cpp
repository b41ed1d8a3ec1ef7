/// crane reset, arm, disarm, stop, estop: each command sends one request.
#include <CLI/CLI.hpp>
#include <memory>

#include "cli/operator_request.hpp"
#include "commands.hpp"

namespace crane::cli {
namespace {

struct Verb {
  const char* name;
  crane_RequestKind kind;
  const char* summary;
  const char* footer;
};

void add(CLI::App& app, Action& chosen, const Verb& verb) {
  auto options = std::make_shared<runtime::BusOptions>(tool_bus());
  auto* command = app.add_subcommand(verb.name, verb.summary);
  auto confirmed = std::make_shared<bool>(false);
  if (verb.kind == crane_REQUEST_RESET)
    command->add_flag(
        "--confirm-positions", *confirmed,
        "after a restart of the bridge: confirm that the positions shown by `crane status` are right");
  runtime::add_bus_options(*command, *options);
  command->footer(verb.footer);
  command->callback([options, confirmed, verb, &chosen] {
    chosen = [options, confirmed, verb] {
      auto bus = open_bus_for(verb.kind, *options);
      const stack::OperatorRequest wanted{.kind = verb.kind,
                                          .selected = {*confirmed, *confirmed, *confirmed}};
      return report(verb.name, ask(bus, wanted));
    };
  });
}

}  // namespace

void add_reset(CLI::App& app, Action& chosen) {
  add(app, chosen,
      {"reset", crane_REQUEST_RESET,
       "Acknowledge a stop after its cause has been removed: from LOCKED or ESTOP to READY",
       "Example: crane reset && crane arm"});
}

void add_arm(CLI::App& app, Action& chosen) {
  add(app, chosen,
      {"arm", crane_REQUEST_ARM, "Open the brakes; the controllers hold the axes: from READY to HOLD",
       "Example: crane arm\nThe crane must be READY; `crane status` shows the cause otherwise."});
}

void add_disarm(CLI::App& app, Action& chosen) {
  add(app, chosen,
      {"disarm", crane_REQUEST_DISARM, "Bring the axes to rest, close the brakes and lock the crane",
       "Example: crane disarm"});
}

void add_stop(CLI::App& app, Action& chosen) {
  add(app, chosen,
      {"stop", crane_REQUEST_STOP,
       "Bring the axes to rest under control, then close the brakes (ends in LOCKED)",
       "Example: crane stop"});
}

void add_estop(CLI::App& app, Action& chosen) {
  add(app, chosen,
      {"estop", crane_REQUEST_ESTOP, "Request an emergency stop: 0 V and closed brakes at once",
       "Example: crane estop\nThe request uses the network. It does not replace the emergency-stop "
       "button."});
}

}  // namespace crane::cli
