#include "crane/boards/board_uses.hpp"

#include <algorithm>
#include <atomic>
#include <random>
#include <string>

#include "crane/boards/shared_lines.hpp"

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

/// 0 marks a new file.
std::uint64_t random_start() {
  std::random_device random;
  return std::uint64_t{random()} << 32U | random() | 1U;
}

class SharedCount {
 public:
  explicit SharedCount(const std::string& name)
      : file_{name}, count_{static_cast<Count*>(file_.map(sizeof(Count)))} {
    std::uint64_t unset = 0;
    count_->compare_exchange_strong(unset, random_start());
  }
  [[nodiscard]] Count& count() { return *count_; }

 private:
  SharedFile file_;
  Count* count_;
};

}  // namespace

std::uint64_t board_uses(const configuration::Rig& rig, const std::string& crane, std::uint32_t domain) {
  return SharedCount{file_name(rig, crane, domain)}.count();
}

void count_board_use(const configuration::Rig& rig, const std::string& crane, std::uint32_t domain) {
  ++SharedCount{file_name(rig, crane, domain)}.count();
}

}  // namespace crane::bridge
