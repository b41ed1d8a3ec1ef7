#pragma once
/// Patterns in the residual of the best hypothesis.
#include <limits>
#include <vector>

#include "data/lost_counts.hpp"
#include "force/unexplained.hpp"
#include "search/search.hpp"

namespace crane::diagnosis {

/// A pattern, with the sum of squares of the base model and the decrease of the sum of squares by the weakest
/// cause on the axis, in the same noise.
struct Pattern {
  Unexplained what;
  double of_base = 0, of_weakest = std::numeric_limits<double>::infinity();
};

/// Patterns in the residual of the drives and lines in the residual of the swing, strongest first.
/// @param losing encoders whose lost counts were restored: residuals that depend on them are explained
[[nodiscard]] std::vector<Pattern> patterns_left(const Study& study, const Hypotheses& hypotheses,
                                                 const std::vector<LosingEncoder>& losing,
                                                 std::uint64_t seed);

/// Whether the pattern is larger than the thresholds permit beside these effects.
[[nodiscard]] bool pattern_share(const Pattern& pattern, const Effects& effects);

}  // namespace crane::diagnosis
