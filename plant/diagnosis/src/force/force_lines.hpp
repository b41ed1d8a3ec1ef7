#pragma once
/// A force on drives or load that comes back in time, whatever the crane does: one line of the spectrum.
#include <cstdint>
#include <optional>

#include "force/unexplained.hpp"

namespace crane::diagnosis {

/// The frequency at which such a force predicts the residual best, out of sample; nothing where flipping the
/// signs of pieces, which leaves no line standing, does as well.
/// @param seed of the sign flips
[[nodiscard]] std::optional<Unexplained> find_force_line(const Pieces& pieces, std::uint64_t seed);

}  // namespace crane::diagnosis
