#pragma once
/// A force on the load that comes back in time, whatever the crane does: one line of the spectrum.
#include "unexplained.hpp"

namespace crane::diagnosis {

/// The frequency at which such a force predicts the swing best, out of sample; nothing where flipping the
/// signs of windows, which leaves no line standing, does as well.
/// @param seed of the sign flips
[[nodiscard]] std::vector<Unexplained> find_swing_lines(const Problem& load, const Fits& fits,
                                                        std::uint64_t seed);

}  // namespace crane::diagnosis
