#pragma once
/// A simulated crane in lockstep whose true rig differs from the rig file of the control loop.
#include <string>
#include <vector>

#include "crane/experiment/comparison.hpp"
#include "crane/simulator/integrator.hpp"
#include "tuning/crane_access.hpp"

namespace crane::control {
struct Controller;
}

namespace crane::tuning {

/// Runs one scenario. The board simulates `truth`; bridge, control laws and supervisor read `rig`. The axes
/// of both start at the same measured positions.
/// @return the run with its figures; every failure is a result
[[nodiscard]] experiment::ComparedRun simulate_on(const configuration::Rig& truth,
                                                  const configuration::Rig& rig,
                                                  const control::Controller& controller,
                                                  const experiment::Scenario& scenario,
                                                  simulator::Method integrator = simulator::Method::cvode);

/// @return channels of the board that `truth` exchanges: the simulated board has no channels, so that a
/// motion would not show the wrong connection. Empty when the channels agree, or when a rig states none
[[nodiscard]] std::vector<std::string> exchanged_channels(const configuration::Rig& truth,
                                                          const configuration::Rig& rig);

class LockstepCrane final : public CraneAccess {
 public:
  explicit LockstepCrane(configuration::Rig truth) : truth_{std::move(truth)} {}
  [[nodiscard]] Motion execute(const configuration::Rig& rig, const experiment::Scenario& scenario) override;

 private:
  configuration::Rig truth_;
};

}  // namespace crane::tuning
