#pragma once
/// The runs of crane run, and their output directories.
#include <filesystem>
#include <string>
#include <vector>

#include "crane/runtime/process.hpp"
#include "experiments/comparison_run.hpp"
#include "stack/stack.hpp"

namespace crane::cli {

using Names = std::vector<std::string>;

struct RunOptions {
  Names scenarios, controllers, variants;
  std::string rig, integrator = "cvode", out = "out", clock = "lockstep";
  stack::Plant plant = stack::Plant::simulated;
  bool compare = false, in_process = false, json = false, no_picture = false;
  runtime::BusOptions bus;
  Names vendors;
  bool twin = false;
  std::string twin_rig;
};

/// One run per scenario, variant and controller of the options; without variants or controllers in the
/// options, those of the scenario, of --compare or of the rig file.
/// @throws configuration::ConfigurationError
[[nodiscard]] std::vector<experiments::PlannedRun> plans_of(const RunOptions& options);

/// Name of the output directory: scenario, controller unless it is the default, variant if any.
[[nodiscard]] std::string directory_name(const RunOptions& options, const experiments::PlannedRun& plan);

/// @throws configuration::ConfigurationError when two runs would write to one directory
void require_own_directories(const RunOptions& options, const std::vector<experiments::PlannedRun>& plans);

/// @throws configuration::ConfigurationError when one of `outputs` is a rig file or a scenario of `plans`
void require_other(const std::vector<std::filesystem::path>& outputs,
                   const std::vector<experiments::PlannedRun>& plans);

}  // namespace crane::cli
