#pragma once
/// Jumps in the residual of a drive: an encoder that loses counts, a brake that grips.
#include <optional>

#include "force/unexplained.hpp"

namespace crane::diagnosis {

/// The strongest jump of position or speed of each piece. Nothing unless kFewestJumpingPieces exceed
/// kClearJumpStatistic.
/// @param pieces of a drive
[[nodiscard]] std::optional<Unexplained> find_jumps(const Pieces& pieces);

}  // namespace crane::diagnosis
