#pragma once
/// Patterns in what the best hypothesis leaves.
#include <limits>
#include <vector>

#include "data/lost_counts.hpp"
#include "force/unexplained.hpp"
#include "search/search.hpp"

namespace crane::diagnosis {

/// A pattern, and in the same noise the squares of the base model and what the weakest of the names on its
/// axis takes off them.
struct Pattern {
  Unexplained what;
  double of_base = 0, of_weakest = std::numeric_limits<double>::infinity();
};

/// Patterns in the residual of the drives and lines in that of the swing, strongest first.
/// @param losing encoders whose jumps were put back: residuals that go with them are explained
[[nodiscard]] std::vector<Pattern> what_is_left(const Study& study, const Hypotheses& hypotheses,
                                                const std::vector<LosingEncoder>& losing, std::uint64_t seed);

/// Whether it is too much to be left beside these effects.
[[nodiscard]] bool pattern_share(const Pattern& pattern, const Effects& effects);

}  // namespace crane::diagnosis
