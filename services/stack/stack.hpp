#pragma once
/// Who belongs to a stack. The topics each process reads and writes stand in its own header; idl/README.md
/// draws them.
#include <vector>

#include "crane/runtime/process.hpp"

namespace crane::stack {

/// The loop with the simulated plant, in the order in which one tick passes through it.
[[nodiscard]] std::vector<runtime::ComponentSpec> simulated_stack();

}  // namespace crane::stack
