/// crane run: runs scenarios in lockstep, with figures of merit, CSV, recording and picture; compares many
/// runs; or runs scenarios in real time as on a rig, with CSV only.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands/commands.hpp"
#include "cli/plant_option.hpp"
#include "cli/run_plans.hpp"
#include "crane/experiment/variant.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/twin/component.hpp"
#include "experiments/comparison_run.hpp"
#include "experiments/experiment_run.hpp"
#include "experiments/realtime_run.hpp"
#include "stack/data_files.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::cli {
namespace {

int run_each(const RunOptions& options, const std::vector<experiments::PlannedRun>& plans) {
  experiments::ExperimentOptions experiment;
  experiment.plant = options.plant;
  experiment.in_process = options.in_process;
  experiment.integrator = simulator::method_named(options.integrator);
  experiment.picture = !options.no_picture;
  experiment.bus = options.bus;
  auto specs = stack::stack_with(experiment.plant);
  if (options.twin || !options.twin_rig.empty()) specs.push_back(twin::twin_spec());
  experiment.vendors = stack::vendors_from(options.vendors, specs);
  if (!options.twin_rig.empty()) experiment.twin = stack::find_rig(options.twin_rig);
  std::vector<experiment::NamedMetrics> table;
  auto json = nlohmann::ordered_json::array();
  bool completed = true;
  for (const auto& plan : plans) {
    experiment.scenario = plan.scenario.path;
    experiment.rig = plan.rig.path;
    experiment.controller = plan.controller->name;
    experiment.variant = plan.variant;
    experiment.directory = options.out;
    if (options.twin && options.twin_rig.empty()) experiment.twin = plan.rig.path;
    if (plans.size() > 1) experiment.directory /= directory_name(options, plan);
    const auto result = experiments::run_experiment(experiment);
    const std::string title = result.scenario + (plan.variant.empty() ? "" : ", " + plan.variant);
    if (!result.outcome.completed)
      std::cerr << title << ", " << result.controller
                << ": the supervisor stopped the crane: " << result.outcome.stopped_because << '\n';
    completed = completed && result.outcome.completed;
    table.push_back({title, result.controller, result.metrics});
    json.push_back(experiments::to_json(result));
    if (!options.json)
      std::cerr << title << ", " << result.controller << ": " << static_cast<long>(result.real_time_factor)
                << " x real time, files in " << experiment.directory.string() << '\n';
  }
  if (options.json)
    std::cout << (plans.size() == 1 ? json.front() : json).dump(2) << '\n';
  else
    experiment::print_table(std::cout, table);
  return completed ? runtime::kExitDone : runtime::kExitFailed;
}

/// Refuses options that need a simulation.
void require_possible_in_realtime(const RunOptions& options,
                                  const std::vector<experiments::PlannedRun>& plans) {
  std::vector<std::string> problems;
  const auto refuse = [&](bool given, const std::string& option) {
    const auto problem = "--clock = realtime: cannot be combined with " + option;
    if (given && std::ranges::find(problems, problem) == problems.end()) problems.push_back(problem);
  };
  refuse(options.compare, "--compare");
  refuse(options.in_process, "--in-process");
  refuse(options.json, "--json");
  refuse(options.twin || !options.twin_rig.empty(), "a twin: crane up --twin");
  for (const auto& plan : plans)  // --compare adds variants itself
    refuse(!options.compare && !plan.variant.empty(),
           "variant " + plan.variant + " of " + plan.scenario.name);
  if (!problems.empty()) throw configuration::ConfigurationError(problems);
}

int run_each_in_realtime(const RunOptions& options, const std::vector<experiments::PlannedRun>& plans) {
  require_possible_in_realtime(options, plans);
  const auto vendors = stack::vendors_from(options.vendors, stack::stack_with(options.plant));
  const auto directory_of = [&](const experiments::PlannedRun& plan) {
    const std::filesystem::path directory{options.out};
    return plans.size() > 1 ? directory / directory_name(options, plan) : directory;
  };
  for (const auto& plan : plans) {  // an error is reported before any motion
    const auto file = directory_of(plan) / "run.csv";
    require_other({file}, plans);
    std::filesystem::create_directories(file.parent_path());
    files::require_writable(file);
  }
  experiments::RealtimeRuns runs{{.plant = options.plant, .bus = options.bus, .vendors = vendors}};
  for (const auto& plan : plans) {
    const auto file = directory_of(plan) / "run.csv";
    const auto run = runs.run(plan.rig.path, std::string{plan.controller->name}, plan.scenario);
    recording::write_csv(file, run.table);
    for (const auto& difference : run.differences) std::cerr << "warning: " << difference << '\n';
    std::cerr << plan.scenario.name << ", " << plan.controller->name << ": in real time, measured data in "
              << file.string() << '\n';
  }
  if (const auto text = runs.difference_from_start(plans.back().rig); !text.empty())
    std::cerr << "warning: " << text << '\n';
  return runtime::kExitDone;
}

void show_progress(std::size_t done, std::size_t all) {
  constexpr std::size_t kWidth = 40;
  const std::size_t filled = kWidth * done / all;
  std::cerr << "\r[" << std::string(filled, '#') << std::string(kWidth - filled, ' ') << "] " << done
            << " of " << all << " runs" << (done == all ? "\n" : "") << std::flush;
}

int compare(const RunOptions& options, const std::vector<experiments::PlannedRun>& plans) {
  const std::filesystem::path directory{options.out};
  require_other({directory / "comparison.csv", directory / "comparison.md", directory / "comparison.html"},
                plans);
  std::filesystem::create_directories(directory);
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  spdlog::set_level(spdlog::level::off);  // the tables contain the cause of a stop
  const auto runs = experiments::simulate_all(plans, [&](std::size_t done) {
    if (terminal) show_progress(done, plans.size());
  });
  files::write_file(directory / "comparison.csv",
                    [&](std::ostream& out) { experiment::write_comparison_csv(out, runs); });
  files::write_file(directory / "comparison.md",
                    [&](std::ostream& out) { experiment::write_comparison_markdown(out, runs); });
  report::write_html(directory / "comparison.html",
                     experiment::comparison_page(runs, plans.front().rig.name));
  if (options.json)
    std::cout << experiment::comparison_json(runs).dump(2) << '\n';
  else
    experiment::write_comparison_summary(std::cout, runs);
  std::cerr << runs.size() << " runs: " << (directory / "comparison").string() << ".csv, .md, .html\n";
  return runtime::kExitDone;
}

int run(const RunOptions& options) {
  runtime::install_stop_signals();
  const auto plans = plans_of(options);
  if (!options.compare && plans.size() > 1) require_own_directories(options, plans);
  if (options.integrator != "cvode" && !options.in_process && !options.compare)
    throw configuration::ConfigurationError(
        {"--integrator = " + options.integrator + ": needs --in-process or --compare"});
  if (options.clock == "realtime") return run_each_in_realtime(options, plans);
  return options.compare ? compare(options, plans) : run_each(options, plans);
}

std::string described_variants() {
  std::string lines = "Variants (combine several with +):\n";
  for (const auto& variant : experiment::variants())
    lines += "  " + std::string{variant.name} + std::string(20 - variant.name.size(), ' ') +
             std::string{variant.summary} + '\n';
  return lines;
}

void add_selection_options(CLI::App& command, RunOptions& options) {
  command.add_option(
      "scenario", options.scenarios,
      "scenario files or names (maneuver_1, figure_4_10, ...); default with --compare: the three "
      "maneuvers");
  command.add_option(
      "--controller", options.controllers,
      "controller (repeatable); default: the controller of the scenario, else of the rig file; with "
      "--compare every controller");
  command
      .add_option(
          "--variants", options.variants,
          "variants of the rig (list below); default: those of the scenario, else none; with --compare the "
          "first eight")
      ->delimiter(',');
  command.add_option(
      "--rig", options.rig,
      std::string{"rig file or name; default: the rig of the scenario, else "} + stack::kDefaultRig);
}

void add_plant_and_clock_options(CLI::App& command, RunOptions& options) {
  command
      .add_option("--integrator", options.integrator,
                  "integrator of the simulated plant: cvode (the reference), or fast (only with "
                  "--in-process or --compare)")
      ->check(CLI::IsMember(Names{simulator::kMethodNames.begin(), simulator::kMethodNames.end()}))
      ->capture_default_str();
  add_plant_option(command, options.plant,
                   ", in lockstep an emulated one (emulated_servo_to_go); not with --compare");
  command
      .add_option(
          "--clock", options.clock,
          "lockstep: simulated time; realtime: also on a real board with --plant hardware; writes run.csv "
          "only, and ignores kicks and initial swing of the scenario")
      ->check(CLI::IsMember({"lockstep", "realtime"}))
      ->capture_default_str();
}

}  // namespace

void add_run(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<RunOptions>();
  auto* command = app.add_subcommand(
      "run", "Run scenarios (files that describe moves) in simulated or real time, and evaluate them");
  add_selection_options(*command, *options);
  add_plant_and_clock_options(*command, *options);
  command->add_option("--out", options->out, "directory for recording, CSV, metrics and picture")
      ->capture_default_str();
  command->add_flag(
      "--compare", options->compare,
      "run all combinations in this process and write comparison.csv, comparison.md, comparison.html");
  command->add_flag("--in-process", options->in_process, "all components in this process, without DDS");
  command->add_flag("--json", options->json, "print metrics as JSON");
  command->add_flag("--no-picture", options->no_picture, "draw no picture");
  command->add_flag("--twin", options->twin,
                    "run a live twin of the rig file (without variants), and record crane/twin; "
                    "not with --compare");
  command->add_option("--twin-rig", options->twin_rig, "run a live twin of this rig file or name");
  command->add_option("--dds-for", options->vendors,
                      "NAME=VENDOR: DDS implementation of one process (repeatable)");
  runtime::add_bus_options(*command, options->bus);
  command->footer(described_variants() +
                  "Examples: crane run maneuver_1 --controller delayed_1 --out out/m1\n"
                  "          crane run next_experiment.toml --clock realtime --plant hardware --rig my_rig\n"
                  "          crane run --compare --out out/comparison\n"
                  "          crane run --compare figure_4_10 --out out/figure_4_10");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace crane::cli
