#include "crane/boards/board_uses.hpp"

#include <algorithm>

namespace crane::bridge {
namespace {

using Count = std::atomic<std::uint64_t>;
static_assert(Count::is_always_lock_free);

std::string file_name(const configuration::Rig& rig, const std::string& crane, std::uint32_t domain) {
  std::string board = rig.board + '_' + std::to_string(rig.wiring.base_address) + '_' + rig.wiring.device;
  if (rig.board == "emulated") board += shared_lines_name(crane, domain);
  std::ranges::replace(board, '/', '_');  // a name of shared memory contains one slash, at its beginning
  return "/crane_board_uses_" + board;
}

}  // namespace

BoardUses::BoardUses(const configuration::Rig& rig, const std::string& crane, std::uint32_t domain)
    : file_{file_name(rig, crane, domain)}, count_{static_cast<const Count*>(file_.map(sizeof(Count)))} {}

BoardUses::~BoardUses() { file_.unlink(); }

void count_board_use(const configuration::Rig& rig, const std::string& crane, std::uint32_t domain) {
  const std::string name = file_name(rig, crane, domain);
  if (!SharedFile::exists(name)) return;
  SharedFile file{name};
  ++*static_cast<Count*>(file.map(sizeof(Count)));
}

}  // namespace crane::bridge
