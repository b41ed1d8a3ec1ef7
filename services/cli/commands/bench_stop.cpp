/// crane bench stop: time from the last toggle of the watchdog output until the brakes are closed, when the
/// hardware bridge is killed or stopped during a move.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands/bench.hpp"
#include "crane/boards/linked_rig.hpp"
#include "experiments/realtime_session.hpp"
#include "stack/data_files.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::cli {
namespace {

using namespace std::chrono_literals;

struct BenchStopOptions {
  stack::LaunchOptions launch;
  std::string rig = "emulated_servo_to_go";
  int runs = 50;
  bool json = false;
};

/// Times since the last toggle of the watchdog output.
struct StopTimes {
  double relay_ms = 0, brakes_ms = 0;
};

void get_to_speed(experiments::RealtimeSession& session) {
  session.arm();
  session.request({.kind = crane_REQUEST_MOVE, .selected = {true, true, false}, .target = {1.0, 1.5, 0}},
                  "move");
  const auto at_speed = [&session] {
    return std::abs(session.state()->trolley_speed_mps) > 0.3 &&
           std::abs(session.state()->slew_speed_radps) > 0.5;
  };
  for (int i = 0; !at_speed(); ++i) {
    if (i > 500) throw experiments::SessionError("the crane does not reach its speed");
    session.wait(5ms);
  }
}

/// Starts a stack and a move of trolley and jib, and sends the signal above 0.3 m/s and 0.5 rad/s. Returns
/// nothing when the crane has not reached this speed, because other load on the computer delayed the stack.
std::optional<StopTimes> stop_once(stack::LaunchOptions launch, int signal) {
  launch.bus.crane = "bench_" + std::to_string(::getpid());
  const auto specs = stack::hardware_stack();
  stack::ChildProcesses children;
  stack::launch_rig(children, configuration::load_rig(launch.rig), launch);
  stack::launch(children, specs, launch);
  bus::Bus bus{runtime::bus_options(launch.bus, "crane_bench", crane_SOURCE_OPERATOR, 0)};
  stack::wait_until_ready(children, specs, bus, 15s);
  experiments::RealtimeSession session{bus, [] {
                                         if (runtime::stop_requested())
                                           throw experiments::SessionError("interrupted");
                                       }};
  const bridge::RigMonitor monitor{bridge::shared_lines_name(launch.bus.crane, launch.bus.domain)};
  const auto& lines = monitor.lines();
  const auto closed_before_ns = lines.brakes_closed_ns.load();
  try {
    get_to_speed(session);
  } catch (const experiments::SessionError& error) {
    if (runtime::stop_requested()) throw;
    std::cerr << "run repeated: " << error.what() << '\n';
    return {};
  }
  const auto signal_ns = runtime::monotonic_ns();
  ::kill(children.pid_of("hardware_bridge").value(), signal);
  for (int i = 0; lines.brakes_closed_ns == closed_before_ns; ++i) {
    if (i > 200) throw experiments::SessionError("the brakes did not close within a second");
    ::usleep(5'000);
  }
  if (lines.relay_dropped_ns < signal_ns || lines.brakes_closed_ns < signal_ns) {
    std::cerr << "run repeated: the crane was stopped before the signal\n";
    return {};
  }
  const auto ms = [&lines](std::int64_t at_ns) {
    return static_cast<double>(at_ns - lines.toggled_ns) * 1e-6;
  };
  return StopTimes{ms(lines.relay_dropped_ns), ms(lines.brakes_closed_ns)};
}

/// @throws experiments::SessionError when the crane does not reach its speed
StopTimes stop_at_speed(const stack::LaunchOptions& launch, int signal) {
  constexpr int kAttempts = 5;
  for (int i = 0; i < kAttempts; ++i)
    if (const auto times = stop_once(launch, signal)) return *times;
  throw experiments::SessionError("the crane did not reach its speed " + std::to_string(kAttempts) +
                                  " times: end other programs on this computer");
}

nlohmann::ordered_json least_and_worst(const std::vector<double>& values) {
  const auto [least, worst] = std::minmax_element(values.begin(), values.end());
  const auto rounded = [](double value_ms) { return std::round(value_ms * 10) / 10; };
  return {{"least", rounded(*least)}, {"worst", rounded(*worst)}};
}

int bench_stop(BenchStopOptions options) {
  runtime::install_stop_signals();
  options.launch.rig = stack::find_rig(options.rig).string();
  if (configuration::load_rig(options.launch.rig).board != "emulated")
    throw configuration::ConfigurationError(
        {options.launch.rig + ": board: must be \"emulated\" for this measurement"});
  auto json = nlohmann::ordered_json::array();
  for (const auto& [name, signal] : {std::pair{"SIGKILL", SIGKILL}, std::pair{"SIGSTOP", SIGSTOP}}) {
    std::vector<double> relay_ms, brakes_ms;
    for (int i = 0; i < (options.runs + 1) / 2; ++i) {
      const auto times = stop_at_speed(options.launch, signal);
      relay_ms.push_back(times.relay_ms);
      brakes_ms.push_back(times.brakes_ms);
    }
    json.push_back({{"signal", name},
                    {"runs", brakes_ms.size()},
                    {"relay_open_ms", least_and_worst(relay_ms)},
                    {"brakes_closed_ms", least_and_worst(brakes_ms)}});
    if (options.json) continue;
    const auto& row = json.back();
    std::cout << name << ", " << brakes_ms.size() << " runs, from the last toggle: relay open after "
              << row["relay_open_ms"]["least"] << " to " << row["relay_open_ms"]["worst"]
              << " ms, brakes closed after " << row["brakes_closed_ms"]["least"] << " to "
              << row["brakes_closed_ms"]["worst"] << " ms" << std::endl;
  }
  if (options.json) std::cout << json.dump(2) << '\n';
  return runtime::kExitDone;
}

}  // namespace

void add_bench_stop(CLI::App& bench, Action& chosen) {
  auto options = std::make_shared<BenchStopOptions>();
  auto* command = bench.add_subcommand("stop",
                                       "Kill or stop the bridge while the emulated crane moves; "
                                       "measure the time until the brakes are closed");
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  command->add_option("--runs", options->runs, "number of runs; half with SIGKILL, half with SIGSTOP")
      ->check(CLI::Range(2, 10000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print as JSON");
  runtime::add_bus_options(*command, options->launch.bus);
  command->footer("Example: crane bench stop --runs 50     (about six seconds per run)");
  command->callback([options, &chosen] { chosen = [options] { return bench_stop(*options); }; });
}

}  // namespace crane::cli
