/// crane dashboard: a page in the browser that shows and operates a running crane.
#include "dashboard/dashboard.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "black_box/black_box.hpp"
#include "commands.hpp"

namespace crane::cli {

namespace {

/// Without --runs the page lists the recordings of this user's black box.
int serve(dashboard::Options options) {
  const auto recorded = black_box::default_directory();
  if (options.runs.empty() && std::filesystem::is_directory(recorded)) options.runs = recorded.string();
  return dashboard::run(options);
}

}  // namespace

void add_dashboard(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<dashboard::Options>(dashboard::default_options());
  auto* command = app.add_subcommand(
      "dashboard",
      "Serve a browser page to watch and operate a running crane, and live data for other viewers");
  dashboard::add_options(*command, *options);
  command->footer(
      "Examples: crane dashboard                                   then open http://127.0.0.1:8765/\n"
      "          crane dashboard --listen 0.0.0.0 --operator-token token    other computers may watch, "
      "and operate with the token\n"
      "Foxglove, Lichtblick and PlotJuggler connect to ws://127.0.0.1:8765 (foxglove.websocket.v1).\n"
      "docs/dashboard.md explains views and permissions.");
  command->callback([options, &chosen] { chosen = [options] { return serve(*options); }; });
}

}  // namespace crane::cli
