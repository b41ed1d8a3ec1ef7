#pragma once
/// Interface to the crane under tuning, which executes scenarios.
#include <string>
#include <vector>

#include "crane/experiment/scenario.hpp"
#include "crane/recording/csv.hpp"

namespace crane::tuning {

struct Motion {
  recording::Table table;       ///< rows of one scenario; time_s is 0 at the start of the run, in HOLD
  std::string stopped_because;  ///< cause of a stop by supervisor or bridge; empty: complete
  std::vector<std::string> differences{};  ///< from the scenario, as experiments::RealtimeRun::differences
};

class CraneAccess {
 public:
  CraneAccess() = default;
  CraneAccess(const CraneAccess&) = delete;
  CraneAccess& operator=(const CraneAccess&) = delete;
  virtual ~CraneAccess() = default;
  /// Arms the crane, executes the scenario with the tracking PD (controller `none`) and locks the crane.
  /// @param rig  rig file of the control loop
  /// @throws experiments::RunError, experiments::SessionError
  [[nodiscard]] virtual Motion execute(const configuration::Rig& rig,
                                       const experiment::Scenario& scenario) = 0;
  /// As experiments::RealtimeRuns::difference_from_start(); empty for a simulated crane.
  [[nodiscard]] virtual std::string difference_from_start(const configuration::Rig& /*rig*/) const {
    return {};
  }
};

}  // namespace crane::tuning
