/// The `crane` command: runs the command of the command line, and reports errors as one line and an exit code
/// (0 done, 1 failure, 2 wrong arguments or files).
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <array>
#include <csignal>
#include <iostream>

#include "commands/commands.hpp"
#include "crane/configuration/rig.hpp"

namespace {

using namespace crane;

constexpr const char* kFooter = R"(A first session, while `crane up` runs in another terminal:
  crane status                      shows the processes, the state of the crane, and the next step
  crane reset && crane arm          leads from LOCKED through READY to HOLD
  crane move --trolley 1.05 --slew 90deg --wait
  crane topic echo crane/state --count 1
  crane record run.mcap --duration 10
Exit code: 0 done, 1 failed (the reason is on standard error), 2 bad arguments or files.
`crane COMMAND --help` explains a command.)";

/// All commands in the order of --help.
constexpr std::array kCommands{
    cli::add_up,        cli::add_demo,       cli::add_run,       cli::add_sweep,    cli::add_identify,
    cli::add_tune,      cli::add_diagnose,   cli::add_status,    cli::add_top,      cli::add_scope,
    cli::add_reset,     cli::add_home,       cli::add_arm,       cli::add_disarm,   cli::add_mode,
    cli::add_move,      cli::add_jog,        cli::add_stop,      cli::add_estop,    cli::add_topic,
    cli::add_graph,     cli::add_doctor,     cli::add_dashboard, cli::add_record,   cli::add_play,
    cli::add_black_box, cli::add_review,     cli::add_replay,    cli::add_log,      cli::add_analyse,
    cli::add_hw,        cli::add_keys,       cli::add_bench,     cli::add_campaign, cli::add_supervisor,
    cli::add_zone,      cli::add_completion, cli::add_man};

/// Logs go to standard error; standard output contains only the result of a command.
void log_to_standard_error() {
  spdlog::set_default_logger(spdlog::stderr_color_mt("crane"));
  spdlog::set_level(spdlog::level::warn);
  spdlog::set_pattern("%^%l%$: %v");
}

/// The innermost command of the command line: "crane", "crane topic", ...
const CLI::App& deepest_of(const CLI::App& app) {
  const auto named = app.get_subcommands();
  return named.empty() ? app : deepest_of(*named.front());
}

int run(const cli::Action& action) {
  try {
    return action();
  } catch (const configuration::ConfigurationError& error) {
    std::cerr << error.what() << '\n';
    return runtime::kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "crane: " << error.what() << '\n';
    return runtime::kExitFailed;
  }
}

}  // namespace

int main(int argc, char** argv) {
  // a write beyond the file-size limit then fails with an error message instead of a signal
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{"Control of gantry and tower cranes as separate processes over DDS.", "crane"};
  app.set_version_flag("--version", "crane " CRANE_VERSION);
  app.footer(kFooter);
  cli::Action chosen;
  for (const auto add : kCommands) add(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? runtime::kExitDone : runtime::kExitBadInput;
  }
  if (!chosen) {
    std::cerr << deepest_of(app).help();
    return runtime::kExitBadInput;
  }
  log_to_standard_error();
  return run(chosen);
}
