#pragma once
/// Runs all components of a control loop in one process in real time: one thread polls the components, which
/// share one DDS participant. Every component keeps its own writers, source and start-up number, so that
/// other programs, and the checks of the components themselves, see the same samples as from separate
/// processes.
#include <string_view>
#include <vector>

#include "crane/runtime/wiring.hpp"

namespace crane::runtime {

/// Program that hosts the whole loop of the simulated plant.
inline constexpr std::string_view kLoopProgram = "crane_loop";

/// main() of the program. Nothing separates the components: an error in one component ends or corrupts all,
/// the supervisor and `LastLine` included. Therefore the specs must not contain a component that controls a
/// real crane (docs/safety.md). @return exit code
int run_loop_process(int argc, char** argv, const std::vector<ComponentSpec>& specs);

}  // namespace crane::runtime
