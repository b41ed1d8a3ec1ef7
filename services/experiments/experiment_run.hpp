#pragma once
/// Runs one experiment (scenario, rig, controller) in lockstep and writes its files:
///   recording.mcap  every topic of every tick      run.csv       canonical columns and more
///   metrics.json    figures of merit               picture.svg   the maneuver
///   rig.toml        the rig with all changes of the run
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "crane/experiment/metrics.hpp"
#include "crane/runtime/process.hpp"
#include "crane/simulator/integrator.hpp"
#include "experiments/lockstep_run.hpp"
#include "stack/stack.hpp"

namespace crane::experiments {

struct ExperimentOptions {
  std::filesystem::path scenario, rig;
  std::string controller;                                   ///< empty: the controller of the rig file
  std::string variant{};                                    ///< name of experiment/variant.hpp; empty: none
  simulator::Method integrator = simulator::Method::cvode;  ///< of the simulated plant; used in_process
  std::filesystem::path directory;                          ///< created when missing
  stack::Plant plant = stack::Plant::simulated;
  bool in_process = false;  ///< true: one process with the memory bus; false: one process per component
  bool picture = true;
  runtime::BusOptions bus;  ///< used when in_process is false
  std::map<std::string, std::string> vendors;
  std::optional<std::filesystem::path> twin{};  ///< rig file of a live twin; nothing: no twin
};

struct ExperimentResult {
  RunOutcome outcome;
  experiment::Metrics metrics;
  std::string scenario, controller, rig, variant;
  double real_time_factor = 0;  ///< simulated time / wall time, from the first to the last tick
};

/// @throws configuration::ConfigurationError for wrong files or names (before anything is started), RunError,
///   recording::WriteError, plot::PictureError
[[nodiscard]] ExperimentResult run_experiment(const ExperimentOptions& options);

/// Runs a scenario in this process. @param started  result of experiment::with_start_of(). @throws RunError
[[nodiscard]] RunOutcome run_in_process(const configuration::Rig& started,
                                        const control::Controller& controller,
                                        const experiment::Scenario& scenario, TickLog& log,
                                        stack::Plant plant = stack::Plant::simulated,
                                        const configuration::Rig* twin = nullptr,
                                        simulator::Method integrator = simulator::Method::cvode);

/// As above, with custom components in the order of stack_with(). @throws RunError
[[nodiscard]] RunOutcome run_in_process(std::span<const runtime::ComponentSpec> components,
                                        const configuration::Rig& started,
                                        const control::Controller& controller,
                                        const experiment::Scenario& scenario, TickLog& log,
                                        const configuration::Rig* twin = nullptr);
[[nodiscard]] nlohmann::ordered_json to_json(const ExperimentResult& result);

}  // namespace crane::experiments
