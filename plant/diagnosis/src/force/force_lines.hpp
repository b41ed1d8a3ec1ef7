#pragma once
/// Force of one frequency on drives or load: a line of the spectrum.
#include <cstdint>
#include <optional>

#include "force/unexplained.hpp"

namespace crane::diagnosis {

/// The strongest line, cross-validated; nothing below a share of the loss, or if one of 99 random sign flips
/// of the pieces gives as strong a line.
/// @param seed of the sign flips
[[nodiscard]] std::optional<Unexplained> find_force_line(const Pieces& pieces, std::uint64_t seed);

}  // namespace crane::diagnosis
