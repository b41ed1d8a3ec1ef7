#pragma once
/// The boards that a rig file can name (configuration/boards.def), each with the function that opens it.
#include <memory>
#include <string_view>
#include <vector>

#include "crane/bridge/board.hpp"
#include "crane/bus/bus.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

/// Opens the board of the rig. @throws BoardError
using MakeBoard = std::unique_ptr<Board>(const configuration::Rig& rig, const bus::Options& bus);

#define CRANE_BOARD(name, meaning) MakeBoard make_##name##_board;
#include "crane/configuration/boards.def"
#undef CRANE_BOARD

struct BoardKind {
  std::string_view name;
  MakeBoard* make;
};
[[nodiscard]] const std::vector<BoardKind>& board_kinds();

/// @throws configuration::ConfigurationError when the rig file names no board, or "simulated"
const BoardKind& board_kind_of(const configuration::Rig& rig);

}  // namespace crane::bridge
