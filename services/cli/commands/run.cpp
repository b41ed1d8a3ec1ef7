/// crane run: one or several scenarios in lockstep, with figures, CSV, recording and picture.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands/commands.hpp"
#include "stack/data_files.hpp"
#include "stack/experiment_run.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::cli {
namespace {

struct RunOptions {
  std::vector<std::string> scenarios;
  std::vector<std::string> controllers;
  std::string rig = "virginia_tech_tower";
  std::string out = "out";
  bool in_process = false, json = false, no_picture = false;
  runtime::BusOptions bus;
  std::vector<std::string> vendors;
};

int run(const RunOptions& options) {
  runtime::install_stop_signals();
  stack::ExperimentOptions experiment;
  experiment.rig = stack::find_rig(options.rig);
  experiment.in_process = options.in_process;
  experiment.picture = !options.no_picture;
  experiment.bus = options.bus;
  experiment.vendors = stack::vendors_from(options.vendors, stack::simulated_stack());

  const auto controllers = options.controllers.empty() ? std::vector<std::string>{""} : options.controllers;
  const bool single = options.scenarios.size() * controllers.size() == 1;
  std::vector<experiment::NamedMetrics> table;
  auto json = nlohmann::ordered_json::array();
  bool completed = true;
  for (const auto& scenario : options.scenarios)
    for (const auto& controller : controllers) {
      experiment.scenario = stack::find_scenario(scenario);
      experiment.controller = controller;
      experiment.directory = options.out;
      if (!single)
        experiment.directory /=
            experiment.scenario.stem().string() + (controller.empty() ? "" : "_" + controller);
      const auto result = stack::run_experiment(experiment);
      if (!result.outcome.completed)
        std::cerr << result.scenario << ", " << result.controller
                  << ": the supervisor stopped the crane: " << result.outcome.stopped_because << '\n';
      completed = completed && result.outcome.completed;
      table.push_back({result.scenario, result.controller, result.metrics});
      json.push_back(stack::to_json(result));
      if (!options.json)
        std::cerr << result.scenario << ", " << result.controller << ": "
                  << static_cast<long>(result.real_time_factor) << " x real time, files in "
                  << experiment.directory.string() << '\n';
    }
  if (options.json)
    std::cout << (single ? json.front() : json).dump(2) << '\n';
  else
    experiment::print_table(std::cout, table);
  return completed ? runtime::kExitDone : runtime::kExitFailed;
}

}  // namespace

void add_run(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<RunOptions>();
  auto* command = app.add_subcommand("run", "Run scenarios in lockstep and measure them");
  command->add_option("scenario", options->scenarios, "scenario files or names (maneuver_1, maneuver_2, ...)")
      ->required();
  command->add_option("--controller", options->controllers,
                      "controller (repeatable); default: the rig file's");
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  command->add_option("--out", options->out, "directory for recording, CSV, metrics and picture")
      ->capture_default_str();
  command->add_flag("--in-process", options->in_process, "all components in this process, without DDS");
  command->add_flag("--json", options->json, "print metrics as JSON");
  command->add_flag("--no-picture", options->no_picture, "do not draw");
  command->add_option("--dds-for", options->vendors,
                      "NAME=VENDOR: another DDS implementation for one process");
  runtime::add_bus_options(*command, options->bus);
  command->footer("Example: crane run maneuver_1 --controller delayed_1 --out out/m1");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace crane::cli
