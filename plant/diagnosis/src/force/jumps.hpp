#pragma once
/// Moments at which a drive's residual changes all at once: an encoder that loses counts, a brake that grips.
#include <optional>

#include "force/unexplained.hpp"

namespace crane::diagnosis {

/// Of each piece the strongest jump of the position or of the speed. Nothing unless several pieces have one
/// that noise and a coloured force do not make.
/// @param pieces of a drive
[[nodiscard]] std::optional<Unexplained> find_jumps(const Pieces& pieces);

}  // namespace crane::diagnosis
