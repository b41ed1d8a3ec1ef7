/// crane_emulated_rig: an emulated Servo-to-Go card with its crane, in a separate process. The process
/// continues when the bridge ends or hangs; the watchdog relay of the emulated rig then closes the brakes.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>

#include "crane/configuration/realtime_period.hpp"
#include "crane/emulated_rig/rig_server.hpp"
#include "crane/runtime/command_line.hpp"
#include "crane/runtime/process.hpp"
#include "crane/runtime/program_start.hpp"
#include "crane/runtime/realtime_scheduling.hpp"

namespace {

using namespace crane;

struct Options {
  std::string rig, crane = "crane", clock = "realtime";
  std::uint32_t domain = 0;
  int model = 1, priority = 60;
};

void enter_realtime(runtime::RealtimeScheduling& scheduling, int priority) {
  const auto answer = scheduling.enter(priority);
  if (const int denied = answer.memory != 0 ? answer.memory : answer.scheduling; denied != 0)
    std::cerr << "crane_emulated_rig: no realtime scheduling: " << std::strerror(denied)
              << "; its relay may react late under load\n";
}

/// The steps are at most a quarter of a tick, so that no toggle of an output is missed.
void run_in_realtime(emulated_rig::RigServer& server, double period_s) {
  const auto step_ns = std::min<std::int64_t>(1'000'000, std::llround(period_s / 4 * 1e9));
  const auto begin_ns = runtime::monotonic_ns();
  for (auto next_ns = begin_ns; !runtime::stop_requested();)
    if (!server.serve_realtime(begin_ns, next_ns)) next_ns += step_ns;
}

int run(const Options& options) {
  const auto rig = configuration::load_rig(options.rig);
  const bool lockstep = options.clock == "lockstep";
  if (!lockstep) configuration::require_realtime_period(rig);
  emulated_rig::RigServer server{rig, bridge::shared_lines_name(options.crane, options.domain), lockstep,
                                 options.model};
  if (lockstep) {
    while (!runtime::stop_requested()) server.serve_advance();
    return runtime::kExitDone;
  }
  runtime::RealtimeScheduling scheduling;
  enter_realtime(scheduling, options.priority);
  run_in_realtime(server, rig.period_s);
  return runtime::kExitDone;
}

}  // namespace

int main(int argc, char** argv) {
  runtime::start_program();
  CLI::App app{
      "A crane with an emulated Servo-to-Go card, for the hardware bridge of the same crane and domain.",
      "crane_emulated_rig"};
  runtime::refuse_values_of_flags(app);
  Options options;
  app.add_option("--rig", options.rig, "rig file: the crane and its wiring")->required();
  app.add_option("--crane", options.crane, "name of the crane")->capture_default_str();
  app.add_option("--domain", options.domain, "DDS domain of the bridge")->capture_default_str();
  app.add_option("--clock", options.clock, "realtime; or lockstep: the bridge advances the time")
      ->check(CLI::IsMember({"realtime", "lockstep"}))
      ->capture_default_str();
  app.add_option("--model", options.model, "model of the Servo-to-Go card")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  app.add_option("--priority", options.priority, "SCHED_FIFO priority in realtime, 0: ordinary scheduling")
      ->check(CLI::Range(0, 98))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return runtime::exit_code_of(app, error);
  }
  runtime::install_stop_signals();
  try {
    return run(options);
  } catch (const configuration::ConfigurationError& error) {
    std::cerr << error.what() << '\n';
    return runtime::kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "crane_emulated_rig: " << error.what() << '\n';
    return runtime::kExitFailed;
  }
}
