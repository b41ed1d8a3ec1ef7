#pragma once
/// The hardware bridge with its emulated crane in the same process, for stacks in one process.
#include <memory>

#include "crane/boards/emulated_board.hpp"
#include "crane/runtime/process.hpp"

namespace crane::emulated_rig {

/// An emulated card with a simulated crane at its connectors, both in this process.
/// @throws std::invalid_argument with all problems of the rig
[[nodiscard]] std::unique_ptr<bridge::Board> open_board(const configuration::Rig& rig);

/// Same as bridge::hardware_bridge_spec(), except that on the memory bus open_board() opens the board.
[[nodiscard]] runtime::ComponentSpec hardware_bridge_spec();

}  // namespace crane::emulated_rig
