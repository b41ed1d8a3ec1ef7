#include "crane/boards/registry.hpp"

#include <algorithm>

namespace crane::bridge {

const std::vector<BoardKind>& board_kinds() {
  static const std::vector<BoardKind> kinds{
#define CRANE_BOARD(name, meaning) {#name, make_##name##_board},
#include "crane/configuration/boards.def"
#undef CRANE_BOARD
  };
  return kinds;
}

const BoardKind& board_kind_of(const configuration::Rig& rig) {
  const auto& kinds = board_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&rig](const BoardKind& kind) { return kind.name == rig.board; });
  if (found != kinds.end()) return *found;
  std::string names;
  for (const auto& kind : kinds) names += (names.empty() ? "" : ", ") + std::string{kind.name};
  throw configuration::ConfigurationError(
      {rig.path + ": board = " + rig.board + ": the hardware bridge drives " + names +
       "; choose one of them, or run the simulated plant (crane up --plant sim)"});
}

}  // namespace crane::bridge
