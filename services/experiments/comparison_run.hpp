#pragma once
/// Many experiments in this process, on all cores.
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/experiment/comparison.hpp"
#include "crane/experiment/scenario.hpp"

namespace crane::experiments {

struct PlannedRun {
  experiment::Scenario scenario;
  configuration::Rig rig;                           ///< as its file says
  const control::Controller* controller = nullptr;  ///< not null
  std::string variant;                              ///< of experiment/variant.hpp, empty: none
};

/// One experiment without files. A crane that the supervisor stops, or that cannot be armed, is a result.
/// @throws configuration::ConfigurationError, and RunError when the user interrupts
[[nodiscard]] experiment::ComparedRun simulate(const PlannedRun& plan);

/// Called after each run with the number that are done; from one thread at a time.
using Progress = std::function<void(std::size_t done)>;

/// simulate() of each, in the order of `plans`. @throws as simulate(), after the runs under way have ended
[[nodiscard]] std::vector<experiment::ComparedRun> simulate_all(std::span<const PlannedRun> plans,
                                                                const Progress& progress);

}  // namespace crane::experiments
