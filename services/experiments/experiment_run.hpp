#pragma once
/// One experiment: a scenario, a rig and a controller, run in lockstep, with everything it leaves behind:
///   recording.mcap  every topic of every tick      run.csv       canonical columns and more
///   metrics.json    figures of merit               picture.svg   the maneuver
///   rig.toml        the rig as it was run
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "crane/experiment/metrics.hpp"
#include "crane/runtime/process.hpp"
#include "experiments/lockstep_run.hpp"
#include "stack/stack.hpp"

namespace crane::experiments {

struct ExperimentOptions {
  std::filesystem::path scenario, rig;
  std::string controller;           ///< empty: the rig's
  std::string variant{};            ///< of experiment/variant.hpp, empty: none
  std::filesystem::path directory;  ///< created when missing
  stack::Plant plant = stack::Plant::simulated;
  bool in_process = false;  ///< one process over the memory bus instead of one per component
  bool picture = true;
  runtime::BusOptions bus;  ///< processes only
  std::map<std::string, std::string> vendors;
  std::optional<std::filesystem::path> twin{};  ///< rig file of a twin that runs beside the stack
};

struct ExperimentResult {
  RunOutcome outcome;
  experiment::Metrics metrics;
  std::string scenario, controller, rig, variant;
  double real_time_factor = 0;  ///< simulated time over wall time, from the first tick to the last
};

/// @throws configuration::ConfigurationError for bad files or names (nothing has been started then),
/// RunError,
///   recording::WriteError, plot::PictureError
[[nodiscard]] ExperimentResult run_experiment(const ExperimentOptions& options);

/// A scenario on the rig as it starts it, in this process. @throws RunError
[[nodiscard]] RunOutcome run_in_process(const configuration::Rig& started,
                                        const control::Controller& controller,
                                        const experiment::Scenario& scenario, TickLog& log,
                                        stack::Plant plant = stack::Plant::simulated,
                                        const configuration::Rig* twin = nullptr);

/// The same with components of one's own, in the order of stack_with(). @throws RunError
[[nodiscard]] RunOutcome run_in_process(std::span<const runtime::ComponentSpec> components,
                                        const configuration::Rig& started,
                                        const control::Controller& controller,
                                        const experiment::Scenario& scenario, TickLog& log,
                                        const configuration::Rig* twin = nullptr);
[[nodiscard]] nlohmann::ordered_json to_json(const ExperimentResult& result);

}  // namespace crane::experiments
