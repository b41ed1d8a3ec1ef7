/// crane dashboard: a page in the browser that shows and operates a running crane.
#include "dashboard/dashboard.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "commands.hpp"

namespace crane::cli {

void add_dashboard(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<dashboard::Options>(dashboard::default_options());
  auto* command = app.add_subcommand(
      "dashboard",
      "Serve a page that shows and operates a running crane, and its data to viewers (docs/dashboard.md)");
  dashboard::add_options(*command, *options);
  command->footer(
      "Examples: crane dashboard                                   then open http://127.0.0.1:8765/\n"
      "          crane dashboard --listen 0.0.0.0 --operator-token token    others look; with the token they "
      "operate\n"
      "Foxglove, Lichtblick and PlotJuggler connect to ws://127.0.0.1:8765 (foxglove.websocket.v1).");
  command->callback([options, &chosen] { chosen = [options] { return dashboard::run(*options); }; });
}

}  // namespace crane::cli
