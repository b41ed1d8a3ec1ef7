#pragma once
/// Runs a scenario in real time with a stack of processes, on a real or simulated crane: reset, arm, a move
/// to the start of the scenario, then its moves and excitations at their times.
#include <map>
#include <string>

#include "crane/experiment/scenario.hpp"
#include "crane/recording/csv.hpp"
#include "crane/runtime/process.hpp"
#include "stack/stack.hpp"

namespace crane::experiments {

struct RealtimeRunOptions {
  std::filesystem::path rig;
  std::string controller;
  stack::Plant plant = stack::Plant::simulated;
  runtime::BusOptions bus;
  std::map<std::string, std::string> vendors;
};

/// Omits kicks, true loads and initial swing of the scenario, which apply to simulations only.
/// @return the run as a table; time_s is 0 when the crane is in HOLD at the start of the scenario
/// @throws configuration::ConfigurationError, SessionError, std::runtime_error
[[nodiscard]] recording::Table run_in_realtime(const RealtimeRunOptions& options,
                                               const experiment::Scenario& scenario);

}  // namespace crane::experiments
