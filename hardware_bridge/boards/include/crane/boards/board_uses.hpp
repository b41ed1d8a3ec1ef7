#pragma once
/// Number of bridges that have opened a board. A program whose bridge has ended can thus find out whether the
/// next bridge on this board is its own: only then do the axes still stand where its last run ended.
#include <cstdint>
#include <string>

#include "crane/configuration/rig.hpp"

namespace crane::bridge {

/// Number of uses of the board of `rig`, plus a random start value: after a removal of the shared memory, the
/// numbers differ from the earlier ones. A board is known by its kind, address and device file; an emulated
/// board also by crane and domain. @throws BoardError when the number cannot be read
[[nodiscard]] std::uint64_t board_uses(const configuration::Rig& rig, const std::string& crane,
                                       std::uint32_t domain);

/// Counts one use. @pre the caller has the board, so that no other bridge can have it.
/// @throws BoardError when the number cannot be written
void count_board_use(const configuration::Rig& rig, const std::string& crane, std::uint32_t domain);

}  // namespace crane::bridge
