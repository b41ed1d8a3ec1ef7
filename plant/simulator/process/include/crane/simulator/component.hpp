#pragma once
/// The simulated plant as a process of the stack: the bridge's loop on the simulated board.
#include "crane/runtime/process.hpp"
#include "crane/simulator/simulated_rig.hpp"

namespace crane::simulator {

[[nodiscard]] runtime::ComponentSpec simulated_plant_spec();

/// The rig file as the simulated board wants it. Limit switches sit at the hard limits, end stops a little
/// beyond.
[[nodiscard]] SimulatedRig simulated_rig_of(const configuration::Rig& rig);

}  // namespace crane::simulator
