/// crane demo: the three maneuvers of the dissertation in real time; writes a table, and a recording and a
/// picture of each.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "cli/commands/commands.hpp"
#include "cli/number_range.hpp"
#include "cli/plant_option.hpp"
#include "crane/bridge/component.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/experiment/metrics.hpp"
#include "crane/experiment/picture.hpp"
#include "crane/runtime/convert.hpp"
#include "dashboard/dashboard.hpp"
#include "experiments/realtime_session.hpp"
#include "recorder/recorder.hpp"
#include "stack/data_files.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::cli {
namespace {

namespace fs = std::filesystem;

struct DemoOptions {
  stack::LaunchOptions launch;
  std::string rig = stack::kDefaultRig;
  stack::Plant plant = stack::Plant::simulated;
  std::string out = "out/demo";
  double seconds_per_maneuver = 10;
  bool dashboard = false;
};

/// Moves to the start of the scenario.
void go_to_start(experiments::RealtimeSession& session, const experiment::Scenario& scenario) {
  const auto& state = *session.state();
  const auto here = runtime::positions(state);
  constexpr double kAtStart = 0.005;  // m, rad: a nearer axis does not move
  std::array<bool, 3> selected{};
  std::array<double, 3> target{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!scenario.start[i] || std::abs(*scenario.start[i] - here[i]) < kAtStart) continue;
    selected[i] = true;
    target[i] = *scenario.start[i];
  }
  if (selected[0] || selected[1] || selected[2]) session.move_to(selected, target, 12s);
}

/// Waits for Ctrl-C, so that the stack keeps running for the viewers of the dashboard.
void keep_up(stack::ChildProcesses& children) {
  std::cout << "the crane stays up for the dashboard; Ctrl-C ends it" << std::endl;
  while (!runtime::stop_requested() && !children.ended()) ::usleep(50'000);
}

/// Records in a separate thread.
using RecorderSlot = std::optional<recorder::Recorder>;

experiment::NamedMetrics run_maneuver(experiments::RealtimeSession& session, bus::Bus& bus,
                                      RecorderSlot& recorder, const configuration::Rig& rig,
                                      const std::string& controller, experiment::Scenario scenario,
                                      const DemoOptions& options) {
  std::cerr << "  " << scenario.name << ": " << scenario.description << '\n';
  go_to_start(session, scenario);
  const fs::path directory{options.out};
  recorder.emplace(bus, recorder::Options{.file = directory / (scenario.name + ".mcap"),
                                          .rig_text = configuration::file_text(options.launch.rig)});
  session.start_table();
  const auto zero_ns = session.state()->header.sample_time_ns;
  for (auto& move : scenario.moves) {
    stack::OperatorRequest wanted{.kind = crane_REQUEST_MOVE};
    for (std::size_t i = 0; i < 3; ++i) {
      wanted.selected[i] = move.target[i].has_value();
      wanted.target[i] = move.target[i].value_or(0);
    }
    move.at_s = static_cast<double>(session.state()->header.sample_time_ns - zero_ns) * 1e-9;
    session.request(wanted, "move");
  }
  session.wait(std::chrono::nanoseconds{static_cast<std::int64_t>(options.seconds_per_maneuver * 1e9)});
  const bool recorded = recorder->close();
  recorder.reset();
  if (!recorded)
    throw experiments::SessionError("the recording of " + scenario.name + " could not be written");

  const auto table = session.table().table(zero_ns);
  recording::write_csv(directory / (scenario.name + ".csv"), table);
  const auto samples = experiment::samples_from(table);
  const auto maneuver = experiment::maneuver_of(scenario, rig);
  experiment::NamedMetrics result{scenario.name, controller, experiment::evaluate(samples, maneuver)};
  experiment::draw_maneuver(directory / (scenario.name + ".svg"), {rig.name, controller, scenario.name},
                            samples, maneuver, result.metrics);
  return result;
}

int demo(DemoOptions options) {
  runtime::install_stop_signals();
  options.launch.rig = stack::find_rig(options.rig).string();
  const auto rig = configuration::load_rig(options.launch.rig);
  const std::string controller{runtime::chosen_controller(options.launch.controller, rig).name};
  std::vector<experiment::Scenario> scenarios;
  for (const auto* name : stack::kManeuvers)
    scenarios.push_back(experiment::load_scenario(stack::find_scenario(name), &rig));
  std::vector<fs::path> outputs;
  for (const auto& scenario : scenarios)
    for (const char* extension : {".mcap", ".csv", ".svg"})
      outputs.push_back(fs::path{options.out} / (scenario.name + extension));
  configuration::require_other(outputs, configuration::with_base_files({options.launch.rig}));
  fs::create_directories(options.out);

  const auto plant = options.plant;
  if (plant == stack::Plant::hardware) bridge::board_kind_of(rig);
  const auto specs = stack::stack_with(plant);
  stack::ChildProcesses children;
  if (plant == stack::Plant::hardware) stack::launch_rig(children, rig, options.launch);
  std::cerr << "starting " << specs.size() << " processes\n";
  stack::launch(children, specs, options.launch);
  auto observer = options.launch.bus;
  observer.vendor = "fastdds";  // as for all tools, so that every run uses both vendors
  bus::Bus bus{runtime::bus_options(observer, "crane_demo", crane_SOURCE_OPERATOR, 0)};
  stack::wait_until_ready(children, specs, bus, stack::kLongestStart);
  if (options.dashboard)
    dashboard::launch(children, options.launch.bus, options.launch.rig, options.out,
                      dashboard::default_options().port);
  RecorderSlot recorder;
  const auto meanwhile = [&children, &recorder] {
    if (recorder) recorder->poll();
    if (const auto ended = children.ended()) throw experiments::SessionError(stack::describe(*ended));
    if (runtime::stop_requested()) throw experiments::SessionError("interrupted");
  };
  experiments::RealtimeSession session{bus, meanwhile};
  std::cerr << "reset, arm\n";
  session.end_at_stops();
  session.arm();
  std::vector<experiment::NamedMetrics> table;
  for (const auto& scenario : scenarios)
    table.push_back(run_maneuver(session, bus, recorder, rig, controller, scenario, options));
  session.disarm();
  experiment::print_table(std::cout, table);
  std::cout << "recordings, CSV files and pictures: " << options.out << '\n';
  if (options.dashboard) keep_up(children);
  children.stop();
  return runtime::kExitDone;
}

}  // namespace

void add_demo(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<DemoOptions>();
  options->launch.bus.crane = "demo";
  auto* command =
      app.add_subcommand("demo", "Run three maneuvers in real time; write a table, recordings and pictures");
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  add_plant_option(*command, options->plant);
  command->add_option("--controller", options->launch.controller,
                      "controller; default: the controller of the rig file");
  command->add_option("--out", options->out, "directory for recordings, CSV files and pictures")
      ->capture_default_str();
  command->add_option("--seconds", options->seconds_per_maneuver, "time measured after each move, in s")
      ->check(number_in(5.0, 60.0))
      ->capture_default_str();
  command->add_flag("--dashboard", options->dashboard,
                    "show the run in a browser page; the stack then runs until Ctrl-C");
  runtime::add_bus_options(*command, options->launch.bus);
  command->footer("Examples: crane demo --controller delayed_1\n          crane demo --dashboard");
  command->callback([options, &chosen] { chosen = [options] { return demo(*options); }; });
}

}  // namespace crane::cli
