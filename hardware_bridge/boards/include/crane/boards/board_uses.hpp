#pragma once
/// Number of times that a board has been opened. A program that starts several bridges one after
/// the other detects by this number that another bridge has opened the board in between and may
/// have moved the axes.
#include <atomic>
#include <cstdint>
#include <string>

#include "crane/boards/shared_lines.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

/// Counts the bridges that open the board of a rig while this object exists. A board is known by its kind,
/// address and device file; an emulated board also by crane and domain.
class BoardUses {
 public:
  /// @throws BoardError when the shared memory of the number cannot be used
  BoardUses(const configuration::Rig& rig, const std::string& crane, std::uint32_t domain);
  ~BoardUses();
  BoardUses(const BoardUses&) = delete;
  BoardUses& operator=(const BoardUses&) = delete;

  [[nodiscard]] std::uint64_t count() const { return *count_; }

 private:
  SharedFile file_;
  const std::atomic<std::uint64_t>* count_;
};

/// Counts one use, if a BoardUses of this board exists. @pre the caller has the board, so that no other
/// bridge can have it. @throws BoardError
void count_board_use(const configuration::Rig& rig, const std::string& crane, std::uint32_t domain);

}  // namespace crane::bridge
