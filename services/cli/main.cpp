/// The `crane` command: runs the command of the command line, and reports errors as one line and an exit code
/// (0 done, 1 failure, 2 wrong arguments or files).
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <iostream>

#include "commands/commands.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/runtime/command_line.hpp"
#include "crane/runtime/program_start.hpp"

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

struct Command {
  void (*add)(CLI::App& app, cli::Action& chosen);  ///< adds one subcommand
  const char* group;                                ///< heading of --help
};

/// All commands in the order of --help.
constexpr std::array kCommands{Command{cli::add_up, "Operate"},
                               Command{cli::add_demo, "Operate"},
                               Command{cli::add_status, "Operate"},
                               Command{cli::add_reset, "Operate"},
                               Command{cli::add_home, "Operate"},
                               Command{cli::add_arm, "Operate"},
                               Command{cli::add_move, "Operate"},
                               Command{cli::add_jog, "Operate"},
                               Command{cli::add_stop, "Operate"},
                               Command{cli::add_estop, "Operate"},
                               Command{cli::add_disarm, "Operate"},
                               Command{cli::add_mode, "Operate"},
                               Command{cli::add_zone, "Operate"},
                               Command{cli::add_top, "Observe"},
                               Command{cli::add_topic, "Observe"},
                               Command{cli::add_scope, "Observe"},
                               Command{cli::add_graph, "Observe"},
                               Command{cli::add_dashboard, "Observe"},
                               Command{cli::add_doctor, "Observe"},
                               Command{cli::add_supervisor, "Observe"},
                               Command{cli::add_black_box, "Record"},
                               Command{cli::add_review, "Record"},
                               Command{cli::add_record, "Record"},
                               Command{cli::add_play, "Record"},
                               Command{cli::add_replay, "Record"},
                               Command{cli::add_log, "Record"},
                               Command{cli::add_run, "Experiment"},
                               Command{cli::add_sweep, "Experiment"},
                               Command{cli::add_analyse, "Experiment"},
                               Command{cli::add_campaign, "Experiment"},
                               Command{cli::add_bench, "Experiment"},
                               Command{cli::add_identify, "Learn from measured data"},
                               Command{cli::add_tune, "Learn from measured data"},
                               Command{cli::add_diagnose, "Learn from measured data"},
                               Command{cli::add_hw, "Set up"},
                               Command{cli::add_keys, "Set up"},
                               Command{cli::add_completion, "Set up"},
                               Command{cli::add_man, "Set up"}};

void add_commands(CLI::App& app, cli::Action& chosen) {
  for (const Command& command : kCommands) {
    command.add(app, chosen);
    app.get_subcommands({}).back()->group(command.group);
  }
}

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

/// A result that could not be written, for example to a full disk, is a failure.
int written(int exit_code) {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  std::cerr << "crane: standard output is incomplete: the disk is full, or the reader has closed the pipe\n";
  return exit_code == runtime::kExitDone ? runtime::kExitFailed : exit_code;
}

int run(int argc, char** argv) {
  CLI::App app{"Control of gantry and tower cranes as separate processes over DDS.", "crane"};
  runtime::refuse_values_of_flags(app);
  app.set_version_flag("--version", "crane " CRANE_VERSION);
  app.footer(kFooter);
  cli::Action chosen;
  try {
    add_commands(app, chosen);
    app.parse(argc, argv);
    if (!chosen) {
      std::cerr << deepest_of(app).help();
      return runtime::kExitBadInput;
    }
    log_to_standard_error();
    return chosen();
  } catch (const CLI::ParseError& error) {
    return runtime::exit_code_of(app, error);
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
  runtime::start_program();
  return written(run(argc, argv));
}
