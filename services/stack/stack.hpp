#pragma once
/// The components of a stack. Each ComponentSpec declares the topics that it reads and writes. `crane graph`
/// and docs/wiring.md show all declarations.
#include <vector>

#include "crane/runtime/process.hpp"

namespace crane::stack {

enum class Plant { simulated, hardware };

/// Components of the control loop in the order of the processing of one tick; the first is the clock master.
[[nodiscard]] std::vector<runtime::ComponentSpec> stack_with(Plant plant);
[[nodiscard]] std::vector<runtime::ComponentSpec> simulated_stack();
/// stack_with() with the hardware bridge instead of the simulated plant.
[[nodiscard]] std::vector<runtime::ComponentSpec> hardware_stack();

}  // namespace crane::stack
