#pragma once
/// Jumps in the residual of a drive: an encoder that loses counts, a brake that grips.
#include <optional>

#include "force/unexplained.hpp"

namespace crane::diagnosis {

/// Jumps of position or speed. Nothing unless the strongest jumps of at least kFewestJumpingPieces pieces
/// have a statistic of at least kClearJumpStatistic (rules.hpp).
/// @param pieces of a drive
[[nodiscard]] std::optional<Unexplained> find_jumps(const Pieces& pieces);

}  // namespace crane::diagnosis
