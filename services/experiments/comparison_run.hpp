#pragma once
/// Runs many experiments in this process, on all cores.
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/experiment/comparison.hpp"
#include "crane/experiment/scenario.hpp"
#include "crane/simulator/integrator.hpp"

namespace crane::experiments {

struct PlannedRun {
  experiment::Scenario scenario;
  configuration::Rig rig;                                   ///< rig file without changes
  const control::Controller* controller = nullptr;          ///< not null
  std::string variant;                                      ///< name of experiment/variant.hpp; empty: none
  simulator::Method integrator = simulator::Method::cvode;  ///< of the simulated plant
};

/// Runs one experiment without files. A stop by the supervisor or a refusal to arm is a result, not an error.
/// @throws configuration::ConfigurationError, and RunError when the user interrupts
[[nodiscard]] experiment::ComparedRun simulate(const PlannedRun& plan);
/// As above, for a crane that differs from the rig file. @param started  rig with the start of the scenario
///   and all changes, including the variant
[[nodiscard]] experiment::ComparedRun simulate(const PlannedRun& plan, const configuration::Rig& started);

/// Called after each run with the number of finished runs; calls do not overlap.
using Progress = std::function<void(std::size_t done)>;

/// Calls simulate() for each plan. @return results in the order of `plans`. @throws exceptions of simulate(),
///   after all started runs have ended
[[nodiscard]] std::vector<experiment::ComparedRun> simulate_all(std::span<const PlannedRun> plans,
                                                                const Progress& progress);

}  // namespace crane::experiments
