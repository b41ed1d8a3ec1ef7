#pragma once
/// The components of a stack. Each ComponentSpec declares the topics it reads and writes; `crane graph` and
/// docs/architecture.md show all of them.
#include <vector>

#include "crane/runtime/process.hpp"

namespace crane::stack {

enum class Plant { simulated, hardware };

/// The loop in the order in which one tick passes through it: clock master first.
[[nodiscard]] std::vector<runtime::ComponentSpec> stack_with(Plant plant);
[[nodiscard]] std::vector<runtime::ComponentSpec> simulated_stack();
/// The bridge in the place of the simulated plant, on the board that the rig file names.
[[nodiscard]] std::vector<runtime::ComponentSpec> hardware_stack();

}  // namespace crane::stack
