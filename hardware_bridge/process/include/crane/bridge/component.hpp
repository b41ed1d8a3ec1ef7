#pragma once
/// The bridge on the board that the rig file names, as a process of the stack.
#include <memory>
#include <string_view>
#include <vector>

#include "crane/bridge/board.hpp"
#include "crane/runtime/process.hpp"

namespace crane::bridge {

/// A board a rig file can name.
struct BoardKind {
  std::string_view name;
  std::unique_ptr<Board> (*make)(const configuration::Rig& rig, const bus::Options& bus);
};
[[nodiscard]] const std::vector<BoardKind>& board_kinds();

/// @throws configuration::ConfigurationError when no hardware board is named, or none this program can drive
const BoardKind& board_kind_of(const configuration::Rig& rig);

[[nodiscard]] runtime::ComponentSpec hardware_bridge_spec();

}  // namespace crane::bridge
