#pragma once
/// A scenario in real time on a stack of processes, for a real crane as for the simulated one: reset, arm, a
/// move to where the scenario starts, then its moves and excitations at their times.
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

/// Kicks, true loads and swings at the start are a simulation's and left out.
/// @return the run as a table; time_s counts from the moment the crane holds at the start of the scenario
/// @throws configuration::ConfigurationError, SessionError, std::runtime_error
[[nodiscard]] recording::Table run_in_realtime(const RealtimeRunOptions& options,
                                               const experiment::Scenario& scenario);

}  // namespace crane::experiments
