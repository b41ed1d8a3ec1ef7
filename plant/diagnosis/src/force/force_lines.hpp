#pragma once
/// A force on drives or load that comes back in time, whatever the crane does: one line of the spectrum.
#include "force/unexplained.hpp"

namespace crane::diagnosis {

/// For every output the frequency at which such a force predicts it best, out of sample; nothing where
/// flipping the signs of windows, which leaves no line standing, does as well.
/// @param seed of the sign flips
[[nodiscard]] std::vector<Unexplained> find_force_lines(const Problem& problem, const Fits& fits,
                                                        std::uint64_t seed);

}  // namespace crane::diagnosis
