/// crane sweep: many experiments in lockstep, from a sweep file.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands/commands.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/workers/process_pool.hpp"
#include "stack/data_files.hpp"
#include "sweep/sweep_run.hpp"

namespace crane::cli {
namespace {

struct SweepOptions {
  std::string file, out = "out/sweep";
  unsigned jobs = workers::processors();
  bool check = false;
};

sweep::Sweep checked_sweep(const SweepOptions& options) {
  std::vector<std::string> problems;
  if (options.jobs < 1 || options.jobs > workers::processors())
    problems.push_back("--jobs = " + std::to_string(options.jobs) + ": must be in [1, " +
                       std::to_string(workers::processors()) + "], the processors of this computer");
  std::optional<sweep::Sweep> sweep;
  try {
    sweep = sweep::load_sweep(stack::find_sweep(options.file), {stack::find_rig, stack::find_scenario});
  } catch (const configuration::ConfigurationError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  }
  if (!problems.empty()) throw configuration::ConfigurationError(problems);
  return std::move(*sweep);
}

/// Prints the progress about ten times a second, and at the end.
class Terminal {
 public:
  void operator()(const sweep::Progress& progress) {
    if (::isatty(STDERR_FILENO) == 0) return;
    if (progress.elapsed_s < next_s_ && progress.done < progress.all) return;
    next_s_ = progress.elapsed_s + 0.1;
    std::cerr << "\r\033[K" << sweep::to_string(progress) << (progress.done == progress.all ? "\n" : "")
              << std::flush;
  }

 private:
  double next_s_ = 0;
};

/// @throws configuration::ConfigurationError when a file of the sweep is one of its inputs
void require_other_files(const SweepOptions& options, const sweep::Sweep& sweep) {
  std::vector<std::filesystem::path> inputs{stack::find_sweep(options.file)}, outputs;
  for (const auto& on : sweep.cases) inputs.insert(inputs.end(), {on.scenario.path, on.rig.path});
  for (const char* name : {sweep::kLogFile, sweep::kRunsFile, sweep::kPageFile})
    outputs.push_back(std::filesystem::path{options.out} / name);
  configuration::require_other(outputs, configuration::with_base_files(inputs));
}

int run(const SweepOptions& options) {
  const auto sweep = checked_sweep(options);
  if (options.check) {
    std::cout << sweep.size() << " runs: " << sweep.cases.size() << " pairs of scenario and rig, "
              << sweep.variants.size() << " variants, " << sweep.controllers.size() << " controllers, "
              << sweep.seeds << " seeds\n";
    return runtime::kExitDone;
  }
  runtime::install_stop_signals();
  spdlog::set_level(spdlog::level::off);  // the table has the cause of a stop
  const std::filesystem::path directory{options.out};
  require_other_files(options, sweep);
  Terminal terminal;
  const auto groups = sweep::run_sweep(sweep, {.directory = directory,
                                               .processes = options.jobs,
                                               .progress = std::ref(terminal),
                                               .cancelled = runtime::stop_requested});
  if (groups.empty()) {
    std::cerr << "\ninterrupted; the same command continues\n";
    return runtime::kExitFailed;
  }
  std::cout << sweep::summary_of(groups);
  std::cerr << sweep.size() << " runs: " << (directory / sweep::kRunsFile).string() << ", "
            << (directory / sweep::kPageFile).string() << '\n';
  return runtime::kExitDone;
}

}  // namespace

void add_sweep(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<SweepOptions>();
  auto* command = app.add_subcommand(
      "sweep", "Run thousands of simulated experiments: scenarios, rigs, variants, controllers, seeds");
  command->add_option("file", options->file, "sweep file or name (friction_and_load, ...)")->required();
  command->add_option("--out", options->out, "directory for runs.csv, sweep.html and the log")
      ->capture_default_str();
  command->add_option("--jobs", options->jobs, "number of runs at the same time; default: one per processor")
      ->capture_default_str();
  command->add_flag("--check", options->check, "check the sweep file and print the number of runs");
  command->footer(
      R"(A sweep file (all keys: docs/sweep.md):
  scenarios = ["maneuver_1", "maneuver_3"]
  controllers = ["all"]               # default: the controller of the rig file
  variants = ["as_is", "observer"]    # default: the rig file as written
  integrator = "fast"                 # default: cvode, the reference
  seeds = 100
  [[draw]]                            # a number of the simulated crane, drawn for each seed
  key = "plant.load_mass_kg"
  low = 1.0
  high = 3.0
After Ctrl-C or a kill, the same command continues. The results do not depend on --jobs.
Example: crane sweep friction_and_load --out out/friction_and_load)");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace crane::cli
