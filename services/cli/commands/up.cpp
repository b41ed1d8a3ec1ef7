/// crane up: runs the stack until Ctrl-C.
#include <CLI/CLI.hpp>
#include <ctime>
#include <iostream>
#include <limits>
#include <memory>

#include "black_box/black_box.hpp"
#include "cli/commands/commands.hpp"
#include "cli/plant_option.hpp"
#include "cli/recording_limits.hpp"
#include "cli/stop_guard.hpp"
#include "crane/bridge/component.hpp"
#include "crane/runtime/node.hpp"
#include "crane/security/keys.hpp"
#include "crane/supervisor/component.hpp"
#include "crane/twin/component.hpp"
#include "dashboard/dashboard.hpp"
#include "experiments/realtime_run.hpp"
#include "experiments/realtime_session.hpp"
#include "stack/data_files.hpp"
#include "stack/launch.hpp"
#include "stack/operator_client.hpp"
#include "stack/service_manager.hpp"
#include "stack/stack.hpp"

namespace crane::cli {
namespace {

struct UpOptions {
  stack::LaunchOptions launch;
  std::string rig = stack::kDefaultRig;
  stack::Plant plant = stack::Plant::simulated;
  bool in_process = false;
  std::string record;
  LimitOptions record_limits;
  std::filesystem::path black_box = black_box::default_directory();
  bool no_black_box = false;
  std::vector<std::string> vendors;
  bool twin = false;
  std::string twin_rig;
  bool dashboard = false;
  unsigned short dashboard_port = dashboard::default_options().port;
  std::filesystem::path dashboard_runs;  ///< empty: the directory of the black box
};

/// The recorder runs on Fast DDS, so that every run uses both vendors.
void start_recorder(stack::ChildProcesses& children, const UpOptions& options) {
  auto bus = options.launch.bus;
  bus.vendor = "fastdds";
  auto arguments = runtime::arguments(bus);
  arguments.insert(arguments.begin(), {"record", options.record, "--rig", options.launch.rig});
  for (auto& argument : cli::arguments(options.record_limits)) arguments.push_back(std::move(argument));
  children.start("recorder", "crane", arguments);
}

constexpr const char* kBlackBox = "black_box";

void start_black_box(stack::ChildProcesses& children, const UpOptions& options) {
  auto bus = options.launch.bus;
  bus.vendor = black_box::default_options().bus.vendor;
  auto arguments = runtime::arguments(bus);
  arguments.insert(arguments.begin(), {"black-box", "--out", options.black_box.string(), "--rig",
                                       options.launch.rig, "--parent", std::to_string(::getpid())});
  children.start(kBlackBox, "crane", arguments);
}

/// @return function that is missing after `process` has ended; empty: the process belongs to the loop
std::string goes_without(const std::string& process) {
  if (process == "recorder") return "a recording";
  if (process == kBlackBox) return "its black box";
  if (process == "twin") return "its twin";
  return process == "dashboard" ? "its dashboard" : "";
}

/// Starts the dashboard and restarts it when it ends, except within a second of its start, because it would
/// end again.
class DashboardKeeper {
 public:
  DashboardKeeper(stack::ChildProcesses& children, const UpOptions& options)
      : children_{children}, options_{options} {}
  void start() {
    dashboard::launch(children_, options_.launch.bus, options_.launch.rig, options_.dashboard_runs.string(),
                      options_.dashboard_port);
    started_ns_ = runtime::monotonic_ns();
  }
  /// @return true when the dashboard runs again
  bool start_again() {
    constexpr std::int64_t kShortest_ns = 1'000'000'000;
    if (runtime::monotonic_ns() - started_ns_ < kShortest_ns) return false;
    start();
    return true;
  }

 private:
  stack::ChildProcesses& children_;
  const UpOptions& options_;
  std::int64_t started_ns_ = 0;
};

/// Tracks the last measured positions of a real crane. When a bridge starts, it assumes that the
/// axes are at `[start]` of the rig file.
class LastPosition {
 public:
  explicit LastPosition(bus::Bus& bus) : states_{bus.subscriber(topics::state)} {}
  void follow() {
    while (const auto state = states_.take()) last_ = *state;
  }
  /// Prints a warning for each axis that is not at `[start]`, and for each brake that was open at
  /// the last measurement. Call when the bridge has ended.
  void warn(const configuration::Rig& rig) {
    follow();
    if (!last_) return;
    const auto text = experiments::difference_from_start(
        rig, {last_->trolley_position_m, last_->slew_angle_rad, last_->cable_length_m});
    if (!text.empty()) std::cerr << "crane up: " << text << '\n';
    for (std::size_t i = 0; i < plant::kAxes; ++i)
      if (rig.drives[i].present && !last_->brake_closed[i])
        std::cerr << "crane up: the brake of the " << plant::kCoordinates[i].name
                  << " was open at the last measurement: the axis may have moved since\n";
  }

 private:
  bus::Subscriber<msg::State> states_;
  std::optional<msg::State> last_;
};

/// Waits for Ctrl-C. @return false when a process of the control loop has ended by itself
bool watch(stack::ChildProcesses& children, DashboardKeeper& dashboard, std::optional<runtime::Node>& node,
           stack::ServiceManager& manager, std::optional<LastPosition>& position) {
  while (!runtime::stop_requested()) {
    if (position) position->follow();
    manager.alive(runtime::monotonic_ns());
    if (const auto ended = children.ended()) {
      const auto without = goes_without(ended->name);
      if (ended->name == "dashboard" && dashboard.start_again()) {
        std::cerr << "crane up: " << stack::describe(*ended) << "; restarting this process\n";
        continue;
      }
      std::cerr << "crane up: " << stack::describe(*ended)
                << (without.empty() ? "; stopping the other processes"
                                    : "; the crane continues without " + without)
                << '\n';
      if (node)
        node->error("process_ended", stack::describe(*ended),
                    without.empty() ? "read the output of `crane up`, then restart the stack" : "");
      if (without.empty()) return false;
    }
    ::usleep(50'000);
  }
  return true;
}

/// Refuses options that --in-process excludes. In one process, an error in another component can corrupt the
/// supervisor and the last check of the bridge; a real crane needs separate processes (docs/safety.md).
void require_possible_in_process(const UpOptions& options) {
  if (!options.in_process) return;
  std::vector<std::string> problems;
  const auto refuse = [&](const std::string& option, const std::string& why) {
    problems.push_back("--in-process: cannot be combined with " + option + ": " + why);
  };
  if (options.plant == stack::Plant::hardware)
    refuse("--plant hardware",
           "an error in one component would end or corrupt supervisor and bridge with it; start the crane "
           "without --in-process");
  if (options.launch.clock == "lockstep")
    refuse("--clock lockstep", "for lockstep in one process use `crane run --in-process`");
  if (!options.launch.bus.secure.empty())
    refuse("--secure", "a process has the rights of one role; the components have six roles");
  for (const auto& entry : options.vendors)
    if (!entry.starts_with("twin="))
      refuse("--dds-for " + entry, "all components of the process use the DDS implementation of --dds");
  if (!problems.empty()) throw configuration::ConfigurationError(std::move(problems));
}

/// A running stack continues after the end of its keys, but no tool can then join it to stop the crane.
void warn_of_keys(const std::string& directory) {
  if (directory.empty()) return;
  const auto warning = security::warning_of_end(std::filesystem::absolute(directory), std::time(nullptr));
  if (!warning.empty()) std::cerr << "crane up: " << warning << '\n';
}

int up(UpOptions options) {
  runtime::install_stop_signals();
  require_possible_in_process(options);
  (void)limits_of(options.record_limits);  // reports problems before any process is started
  options.launch.rig = stack::find_rig(options.rig).string();
  const auto rig = configuration::load_rig(options.launch.rig);
  const auto& controller = runtime::chosen_controller(options.launch.controller, rig);
  const auto plant = options.plant;
  if (plant == stack::Plant::hardware) bridge::board_kind_of(rig);
  auto specs = stack::stack_with(plant);
  const auto loop = specs;
  if (options.twin || !options.twin_rig.empty()) specs.push_back(twin::twin_spec());
  const auto twin_rig =
      options.twin_rig.empty() ? options.launch.rig : stack::find_rig(options.twin_rig).string();
  (void)configuration::load_rig(twin_rig);  // reports problems of the rig file before any process is started
  options.launch.vendors = stack::vendors_from(options.vendors, specs);

  warn_of_keys(options.launch.bus.secure);
  bus::Bus bus{runtime::bus_options(options.launch.bus, "crane_up", crane_SOURCE_OPERATOR, 0)};
  runtime::refuse_second_writer(bus, supervisor::supervisor_spec().writes);
  StopGuard guard;
  stack::ChildProcesses children;
  if (plant == stack::Plant::hardware) stack::launch_rig(children, rig, options.launch);
  if (options.in_process)
    stack::launch_in_process(children, options.launch);
  else
    stack::launch(children, loop, options.launch);
  if (specs.size() > loop.size()) stack::launch_twin(children, twin_rig, options.launch);
  if (!options.record.empty()) start_recorder(children, options);
  if (!options.no_black_box) start_black_box(children, options);
  DashboardKeeper dashboard{children, options};
  if (options.dashboard_runs.empty()) options.dashboard_runs = options.black_box;
  if (options.dashboard) {
    std::error_code ignored;  // the dashboard then lists no runs
    std::filesystem::create_directories(options.dashboard_runs, ignored);
    dashboard.start();
  }
  std::optional<stack::Ended> black_box;  // if it has ended during the start
  stack::wait_until_ready(children, specs, bus, stack::kLongestStart, [&](const stack::Ended& ended) {
    if (ended.name != kBlackBox) return false;
    black_box = ended;
    return true;
  });
  if (options.launch.clock == "lockstep")
    stack::OperatorClient{bus, "crane_up", experiments::unique_first_id()}.send(
        {.kind = crane_REQUEST_ADVANCE, .until_tick = std::numeric_limits<std::uint64_t>::max()});
  std::cout << rig.name << " is up with " << controller.name << " (crane '" << options.launch.bus.crane
            << "', domain " << options.launch.bus.domain << ", " << options.launch.clock << ")\n"
            << (black_box ? "stops are not recorded: " + stack::describe(*black_box) + "\n" : "")
            << "next: crane status, crane reset, crane arm, crane move --trolley 0.8; Ctrl-C ends it"
            << std::endl;
  std::optional<runtime::Node> node;  // with keys, the role operator may not write crane/node
  if (options.launch.bus.secure.empty()) node.emplace(bus, runtime::NodeIdentity{"crane_up", ""});
  if (black_box && node)
    node->error("process_ended", stack::describe(*black_box) + "; stops are not recorded",
                "read the output of `crane up`, then restart the stack");
  std::optional<LastPosition> position;
  if (plant == stack::Plant::hardware) position.emplace(bus);
  stack::ServiceManager manager;
  manager.ready();
  const bool orderly = watch(children, dashboard, node, manager, position);
  guard.stopping();
  manager.stopping();
  children.stop();
  if (position) position->warn(rig);
  return orderly ? runtime::kExitDone : runtime::kExitFailed;
}

}  // namespace

void add_up(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<UpOptions>();
  auto* command = app.add_subcommand("up", "Start all processes of a crane (the stack); run until Ctrl-C");
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  add_plant_option(*command, options->plant);
  command->add_option("--controller", options->launch.controller,
                      "controller; default: the controller of the rig file");
  command
      ->add_option("--clock", options->launch.clock,
                   "realtime: one tick per period; lockstep: simulated time, as fast as possible")
      ->check(CLI::IsMember({"realtime", "lockstep"}))
      ->capture_default_str();
  command->add_flag("--in-process", options->in_process,
                    "run all components of the loop in one process, which takes less processor time and "
                    "memory; only with the simulated plant, because an error in one component ends or "
                    "corrupts all components (docs/fleet.md)");
  command->add_option("--record", options->record, "record every topic to this MCAP file");
  add_limit_options(*command, options->record_limits, "--record-");
  command
      ->add_option("--black-box", options->black_box,
                   "directory for the recordings of stops and faults (docs/black_box.md)")
      ->capture_default_str();
  command->add_flag("--no-black-box", options->no_black_box, "do not record stops and faults");
  command->add_flag("--twin", options->twin,
                    "run a live twin: a model beside the crane that reports deviations (docs/twin.md)");
  command->add_option("--twin-rig", options->twin_rig,
                      "run a live twin of this rig file, for example extended.toml of crane diagnose");
  command->add_flag("--dashboard", options->dashboard,
                    "serve a browser page to watch and operate this crane (docs/dashboard.md)");
  command->add_option("--dashboard-port", options->dashboard_port, "port of --dashboard")
      ->capture_default_str();
  command
      ->add_option("--dashboard-runs", options->dashboard_runs,
                   "directory of recordings that the dashboard lists; default: the directory of --black-box")
      ->check(CLI::ExistingDirectory);
  for (const char* option : {"--record-split-size", "--record-split-every", "--record-quota"})
    command->get_option(option)->needs("--record");
  for (const char* option : {"--dashboard-port", "--dashboard-runs"})
    command->get_option(option)->needs("--dashboard");
  command->add_option("--dds-for", options->vendors,
                      "NAME=VENDOR: DDS implementation of one process (repeatable)");
  command->add_option("--priority", options->launch.priority, "SCHED_FIFO priority, 0: ordinary scheduling")
      ->check(CLI::Range(0, 98))
      ->capture_default_str();
  command->add_flag("--verbose", options->launch.verbose, "log debug messages");
  runtime::add_bus_options(*command, options->launch.bus);
  command->footer(
      "Examples: crane up --dashboard                             (then open http://127.0.0.1:8765/)\n"
      "          crane up --rig virginia_tech_tower --record run.mcap\n"
      "          crane up --in-process --crane crane_7                    (one of many cranes: "
      "docs/fleet.md)\n"
      "          crane up --plant hardware --rig emulated_servo_to_go     (docs/hardware.md)");
  command->callback([options, &chosen] { chosen = [options] { return up(*options); }; });
}

}  // namespace crane::cli
