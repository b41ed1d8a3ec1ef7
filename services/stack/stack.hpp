#pragma once
/// Who belongs to a stack. The topics each process reads and writes stand in its own header; idl/README.md
/// draws them.
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
