#pragma once
/// Runs all components of a control loop in one process in real time. One thread polls the components. The
/// components share one DDS participant; each has its own writers, readers, source and start-up number. The
/// samples are the same as with separate processes.
#include <string_view>
#include <vector>

#include "crane/runtime/wiring.hpp"

namespace crane::runtime {

/// Program that runs the whole loop of the simulated plant.
inline constexpr std::string_view kLoopProgram = "crane_loop";

/// main() of the program. An error in one component ends or corrupts all components, including the supervisor
/// and `LastLine`. Therefore `specs` must not contain a component that controls a real crane
/// (docs/safety.md).
/// @return exit code
int run_loop_process(int argc, char** argv, const std::vector<ComponentSpec>& specs);

}  // namespace crane::runtime
