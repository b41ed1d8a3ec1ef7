#include "experiments/experiment_run.hpp"

#include <unistd.h>

#include <nlohmann/json.hpp>

#include "crane/bridge/component.hpp"
#include "crane/configuration/encoder_resolution.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/experiment/picture.hpp"
#include "crane/experiment/variant.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/runtime/in_process.hpp"
#include "crane/simulator/component.hpp"
#include "crane/twin/component.hpp"
#include "experiments/rig_at_start_file.hpp"
#include "stack/child_processes.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::experiments {
namespace {

constexpr const char* kRigFile = "rig.toml";
constexpr const char* kRecording = "recording.mcap";
constexpr const char* kTable = "run.csv";
constexpr const char* kMetrics = "metrics.json";
constexpr const char* kPicture = "picture.svg";

namespace fs = std::filesystem;

RunOutcome run_in_processes(const ExperimentOptions& options, const fs::path& rig_file,
                            const configuration::Rig& rig, const control::Controller& controller,
                            const experiment::Scenario& scenario, TickLog& log) {
  auto specs = stack::stack_with(options.plant);
  stack::LaunchOptions launch_options{.bus = options.bus,
                                      .vendors = options.vendors,
                                      .rig = rig_file.string(),
                                      .controller = std::string{controller.name},
                                      .clock = "lockstep",
                                      .epoch = 1};
  launch_options.bus.crane +=
      "_run_" + std::to_string(::getpid());  // the name differs from that of a real crane
  stack::ChildProcesses children;
  if (options.plant == stack::Plant::hardware) stack::launch_rig(children, rig, launch_options);
  stack::launch(children, specs, launch_options);
  if (options.twin) {
    stack::launch_twin(children, options.twin->string(), launch_options);
    specs.push_back(twin::twin_spec());
  }
  bus::Bus bus{runtime::bus_options(launch_options.bus, "crane_run", crane_SOURCE_OPERATOR, 1)};
  stack::wait_until_ready(children, specs, bus, std::chrono::seconds{15});
  const Pump pump = [&] {
    bus.wait(std::chrono::milliseconds{20});
    if (const auto ended = children.ended()) throw RunError(stack::describe(*ended));
  };
  return run_scenario(bus, pump, rig, scenario, log, specs);
}

/// Requires a simulated or emulated crane, because in lockstep the crane waits for commands and starts at the
/// start of the scenario.
void require_rehearsal(const configuration::Rig& rig) {
  bridge::board_kind_of(rig);
  if (rig.board != "emulated")
    throw configuration::ConfigurationError({rig.path + ": board = " + rig.board +
                                             ": lockstep needs board = \"emulated\"; drive a real crane with "
                                             "`crane up --plant hardware` and `crane move`"});
}

/// Metadata of a recording, with everything that `crane replay` needs besides the rig file.
recording::Metadata origin_of(const ExperimentOptions& options, const ExperimentResult& run) {
  return {
      {"clock", "lockstep"},
      {"rig", run.rig},
      {"controller", run.controller},
      {"scenario", run.scenario},
      {"variant", run.variant},
      {"plant", options.plant == stack::Plant::hardware ? "hardware" : "sim"},
      {"integrator", std::string{simulator::kMethodNames.at(static_cast<std::size_t>(options.integrator))}},
      {"version", CRANE_VERSION},
      {"log_time", "sample time: tick times period, ns"},
      {"publish_time", "sample time: tick times period, ns"},
      {"sequence", "tick"}};
}

/// @throws configuration::ConfigurationError when a file of the run is one of its inputs
void require_other_files(const ExperimentOptions& options) {
  std::vector<fs::path> inputs{options.rig, options.scenario};
  if (options.twin) inputs.push_back(*options.twin);
  std::vector<fs::path> outputs;
  for (const char* name : {kRigFile, kRecording, kTable, kMetrics, kPicture})
    outputs.push_back(options.directory / name);
  configuration::require_other(outputs, configuration::with_base_files(inputs));
}

}  // namespace

RunOutcome run_in_process(const configuration::Rig& rig, const control::Controller& controller,
                          const experiment::Scenario& scenario, TickLog& log, stack::Plant plant,
                          const configuration::Rig* twin, simulator::Method integrator) {
  auto components = stack::stack_with(plant);
  if (plant == stack::Plant::simulated) components.front() = simulator::simulated_plant_spec(integrator);
  return run_in_process(components, rig, controller, scenario, log, twin);
}

RunOutcome run_in_process(std::span<const runtime::ComponentSpec> components, const configuration::Rig& rig,
                          const control::Controller& controller, const experiment::Scenario& scenario,
                          TickLog& log, const configuration::Rig* twin) {
  runtime::InProcessStack stack{components, rig, controller};
  std::vector<runtime::ComponentSpec> all{components.begin(), components.end()};
  if (twin != nullptr) all.push_back(twin::twin_spec());
  if (twin != nullptr) stack.add(all.back(), *twin, controller);
  bus::Bus bus{runtime::memory_options(stack.network(), "crane_run", crane_SOURCE_OPERATOR)};
  // The timeout of the run ends the wait for an answer that does not arrive.
  return run_scenario(
      bus, [&stack] { stack.pump(); }, rig, scenario, log, all);
}

nlohmann::ordered_json to_json(const ExperimentResult& result) {
  nlohmann::ordered_json json{{"scenario", result.scenario},
                              {"controller", result.controller},
                              {"rig", result.rig},
                              {"variant", result.variant},
                              {"completed", result.outcome.completed}};
  if (!result.outcome.completed) json["stopped_because"] = result.outcome.stopped_because;
  json.update(experiment::to_json(result.metrics));
  json["real_time_factor"] = result.real_time_factor;
  return json;
}

ExperimentResult run_experiment(const ExperimentOptions& options) {
  const auto rig = configuration::load_rig(options.rig);
  configuration::require_resolved_speeds(rig);
  if (options.plant == stack::Plant::hardware) require_rehearsal(rig);
  const auto& controller = runtime::chosen_controller(options.controller, rig);
  const auto scenario = experiment::load_scenario(options.scenario, &rig);
  const auto started = experiment::changed_by(experiment::with_start_of(rig, scenario), options.variant);
  require_other_files(options);
  fs::create_directories(options.directory);
  const auto rig_file = options.directory / kRigFile;
  write_rig_at_start(rig_file, started);

  std::optional<configuration::Rig> twin;
  if (options.twin) twin = configuration::load_rig(*options.twin);

  TickLog log{options.directory / kRecording};
  ExperimentResult result;
  result.scenario = scenario.name;
  result.controller = controller.name;
  result.rig = rig.name;
  result.variant = options.variant;
  log.describe(origin_of(options, result), rig_at_start_text(started));
  result.outcome = options.in_process
                       ? run_in_process(started, controller, scenario, log, options.plant,
                                        twin ? &*twin : nullptr, options.integrator)
                       : run_in_processes(options, rig_file, started, controller, scenario, log);
  log.close();
  result.real_time_factor =
      static_cast<double>(result.outcome.last_tick) * rig.period_s / result.outcome.wall_s;

  const auto table = log.table(result.outcome.hold_tick);
  recording::write_csv(options.directory / kTable, table);
  const auto samples = experiment::samples_from(table);
  const auto maneuver = experiment::maneuver_of(scenario, started);
  if (!result.outcome.completed && (samples.empty() || samples.back().time_s < maneuver.last_action_s))
    throw RunError("the supervisor stopped the crane before its last move or kick: " +
                   result.outcome.stopped_because);
  result.metrics = experiment::evaluate(samples, maneuver);
  files::write_file(options.directory / kMetrics, to_json(result).dump(2) + "\n");
  if (options.picture)
    experiment::draw_maneuver(options.directory / kPicture, {rig.name, result.controller, scenario.name},
                              samples, maneuver, result.metrics);
  return result;
}

}  // namespace crane::experiments
