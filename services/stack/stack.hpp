#pragma once
/// The components of a stack. Each ComponentSpec declares the topics that it reads and writes. `crane graph`
/// and docs/wiring.md show all declarations.
#include <vector>

#include "crane/runtime/process.hpp"

namespace crane::stack {

/// Clock master of a stack: the simulated plant, or the hardware bridge with the board of the rig file.
enum class Plant { simulated, hardware };

/// Components of the control loop, in the order in which they process a tick. The first is the clock master.
[[nodiscard]] std::vector<runtime::ComponentSpec> stack_with(Plant plant);
/// stack_with(Plant::simulated).
[[nodiscard]] std::vector<runtime::ComponentSpec> simulated_stack();
/// stack_with(Plant::hardware).
[[nodiscard]] std::vector<runtime::ComponentSpec> hardware_stack();

}  // namespace crane::stack
