#include "stack/experiment_run.hpp"

#include <unistd.h>

#include <fstream>

#include "crane/experiment/picture.hpp"
#include "crane/runtime/in_process.hpp"
#include "stack/child_processes.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::stack {
namespace {

namespace fs = std::filesystem;

/// The rig as the scenario starts it, as a file for the processes of the stack.
void write_started_rig(const fs::path& file, const runtime::Rig& rig, const runtime::Rig& started) {
  std::ofstream out{file};
  out << "# " << rig.name << " as one experiment starts it\n"
      << "extends = \"" << fs::absolute(rig.path).string() << "\"\n\n[start]\n";
  constexpr std::array kPosition{"trolley_position_m", "slew_angle_rad", "cable_length_m"};
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    if (rig.drives[i].present || i == plant::kHoist)
      out << kPosition[i] << " = " << recording::shortest(started.start.position[i]) << '\n';
  out << "swing_radial_rad = " << recording::shortest(started.start.swing_radial_rad) << '\n'
      << "swing_tangential_rad = " << recording::shortest(started.start.swing_tangential_rad) << '\n';
  if (started.plant.load_mass_kg != rig.plant.load_mass_kg)
    out << "\n[plant]\nload_mass_kg = " << recording::shortest(started.plant.load_mass_kg)
        << "\n\n[controller.believes]\nload_mass_kg = " << recording::shortest(rig.design.crane.load_mass_kg)
        << '\n';
  if (!out.flush()) throw RunError(file.string() + ": cannot write");
}

RunOutcome run_in_process(const runtime::Rig& rig, const control::Controller& controller,
                          const experiment::Scenario& scenario, TickLog& log) {
  const auto specs = simulated_stack();
  runtime::InProcessStack stack{specs, rig, controller};
  bus::Bus bus{runtime::memory_options(stack.network(), "crane_run", crane_SOURCE_OPERATOR)};
  // With nothing to do but wait for an answer that never comes, the time-out of the run ends it.
  return run_scenario(
      bus, [&stack] { stack.pump(); }, rig, scenario, log);
}

RunOutcome run_in_processes(const ExperimentOptions& options, const fs::path& rig_file,
                            const runtime::Rig& rig, const control::Controller& controller,
                            const experiment::Scenario& scenario, TickLog& log) {
  const auto specs = simulated_stack();
  LaunchOptions launch_options{.bus = options.bus,
                               .vendors = options.vendors,
                               .rig = rig_file.string(),
                               .controller = std::string{controller.name},
                               .clock = "lockstep",
                               .epoch = 1};
  launch_options.bus.crane +=
      "_run_" + std::to_string(::getpid());  // never meets a crane that is really there
  ChildProcesses children;
  launch(children, specs, launch_options);
  bus::Bus bus{runtime::bus_options(launch_options.bus, "crane_run", crane_SOURCE_OPERATOR, 1)};
  wait_until_ready(children, specs, bus, std::chrono::seconds{15});
  const Pump pump = [&] {
    bus.wait(std::chrono::milliseconds{20});
    if (const auto ended = children.ended()) throw RunError(describe(*ended));
  };
  return run_scenario(bus, pump, rig, scenario, log);
}

void write_json(const fs::path& file, const nlohmann::ordered_json& json) {
  std::ofstream out{file};
  out << json.dump(2) << '\n';
  if (!out.flush()) throw RunError(file.string() + ": cannot write");
}

}  // namespace

nlohmann::ordered_json to_json(const ExperimentResult& result) {
  nlohmann::ordered_json json{{"scenario", result.scenario},
                              {"controller", result.controller},
                              {"rig", result.rig},
                              {"completed", result.outcome.completed}};
  if (!result.outcome.completed) json["stopped_because"] = result.outcome.stopped_because;
  json.update(experiment::to_json(result.metrics));
  json["real_time_factor"] = result.real_time_factor;
  return json;
}

ExperimentResult run_experiment(const ExperimentOptions& options) {
  const auto rig = runtime::load_rig(options.rig);
  const auto& controller = runtime::chosen_controller(options.controller, rig);
  const auto scenario = experiment::load_scenario(options.scenario, &rig);
  const auto started = experiment::started_by(rig, scenario);
  fs::create_directories(options.directory);
  const auto rig_file = options.directory / "rig.toml";
  write_started_rig(rig_file, rig, started);

  TickLog log{options.directory / "recording.mcap"};
  ExperimentResult result;
  result.scenario = scenario.name;
  result.controller = controller.name;
  result.rig = rig.name;
  result.outcome = options.in_process
                       ? run_in_process(started, controller, scenario, log)
                       : run_in_processes(options, rig_file, started, controller, scenario, log);
  log.close();
  result.real_time_factor =
      static_cast<double>(result.outcome.last_tick) * rig.period_s / result.outcome.wall_s;

  const auto table = log.table(result.outcome.hold_tick);
  recording::write_csv(options.directory / "run.csv", table);
  const auto samples = experiment::samples_from(table);
  const auto maneuver = experiment::maneuver_of(scenario, rig);
  result.metrics = experiment::evaluate(samples, maneuver);
  write_json(options.directory / "metrics.json", to_json(result));
  if (options.picture)
    experiment::draw_maneuver(options.directory / "picture.svg", {rig.name, result.controller, scenario.name},
                              samples, maneuver, result.metrics);
  return result;
}

}  // namespace crane::stack
