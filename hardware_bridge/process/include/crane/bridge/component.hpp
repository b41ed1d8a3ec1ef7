#pragma once
/// The bridge on the board that the rig file names, as a process of the stack.
#include "crane/boards/registry.hpp"
#include "crane/runtime/process.hpp"

namespace crane::bridge {

[[nodiscard]] runtime::ComponentSpec hardware_bridge_spec();

}  // namespace crane::bridge
