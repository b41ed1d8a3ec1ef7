#include "host.hpp"

#include <spdlog/async.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <iostream>

#include "crane/runtime/command_line.hpp"
#include "crane/runtime/node.hpp"
#include "crane/runtime/program_start.hpp"
#include "crane/runtime/signals.hpp"
#include "crane/runtime/spin_limit.hpp"

namespace crane::runtime {
namespace {

/// A stopped terminal (Ctrl-S) or a full pipe blocks its writer. Therefore a separate thread writes the log
/// lines of the loop. When kMostLines lines wait, the oldest is dropped.
void log_without_waiting() {
  constexpr std::size_t kMostLines = 256;
  spdlog::drop_all();
  spdlog::init_thread_pool(kMostLines, 1);
  spdlog::set_default_logger(spdlog::create_async_nb<spdlog::sinks::stderr_color_sink_mt>(""));
}

}  // namespace

void enter_realtime(RealtimeScheduling& scheduling, Node& node, int priority) {
  if (priority <= 0) return;
  const auto answer = scheduling.enter(priority);
  if (answer.memory != 0)
    node.warning("memory_not_locked", std::string{"mlockall failed: "} + std::strerror(answer.memory),
                 "grant CAP_IPC_LOCK or raise the memlock limit");
  limit_spin_time();
  if (answer.scheduling != 0)
    node.warning("no_realtime_scheduling",
                 std::string{"SCHED_FIFO not permitted: "} + std::strerror(answer.scheduling),
                 "ticks may be late under load; grant CAP_SYS_NICE or start with --priority 0");
}

Clock clock_from(const std::string& name) {
  if (name == "realtime") return Clock::realtime;
  if (name == "lockstep") return Clock::lockstep;
  throw configuration::ConfigurationError({"--clock " + name + ": must be realtime or lockstep"});
}

int host(int argc, char** argv, const std::string& program, const std::string& summary,
         const std::function<int(const LoopOptions&)>& run) {
  start_program();
  CLI::App app{summary, program};
  refuse_values_of_flags(app);
  LoopOptions options;
  add_loop_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return exit_code_of(app, error);
  }
  try {
    log_without_waiting();
    spdlog::set_level(options.verbose ? spdlog::level::debug : spdlog::level::warn);
    install_stop_signals();
    if (options.parent != 0) end_with_parent(options.parent);
    return run(options);
  } catch (const configuration::ConfigurationError& error) {
    std::cerr << error.what() << '\n';
    return kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return kExitFailed;
  } catch (...) {  // ensures stack unwinding: the bridge then leaves its board at 0 V with closed brakes
    std::cerr << program << ": ended by an exception of an unknown type\n";
    return kExitFailed;
  }
}

}  // namespace crane::runtime
