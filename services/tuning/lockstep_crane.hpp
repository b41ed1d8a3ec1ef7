#pragma once
/// A simulated crane in lockstep whose true rig differs from the rig file of the control loop.
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

class LockstepCrane final : public CraneAccess {
 public:
  explicit LockstepCrane(configuration::Rig truth) : truth_{std::move(truth)} {}
  [[nodiscard]] Motion execute(const configuration::Rig& rig, const experiment::Scenario& scenario) override;

 private:
  configuration::Rig truth_;
};

}  // namespace crane::tuning
