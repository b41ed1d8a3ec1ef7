#pragma once
/// The simulated plant as a process of the stack: the loop of the bridge on a simulated board.
#include "crane/runtime/process.hpp"
#include "crane/simulator/simulated_rig.hpp"

namespace crane::simulator {

[[nodiscard]] runtime::ComponentSpec simulated_plant_spec(Method integrator = Method::cvode);

/// Converts a rig file to the parameters of the simulated board. The limit switches are at the hard limits,
/// the end stops 0.02 m or 0.02 rad beyond.
[[nodiscard]] SimulatedRig simulated_rig_of(const configuration::Rig& rig);

}  // namespace crane::simulator
