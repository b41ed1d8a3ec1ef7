#pragma once
/// Patterns in the residual of the best hypothesis.
#include <limits>
#include <vector>

#include "data/lost_counts.hpp"
#include "force/short_force.hpp"
#include "force/swing_patterns.hpp"
#include "force/unexplained.hpp"
#include "search/search.hpp"

namespace crane::diagnosis {

/// A pattern. `of_base` is the sum of squares of the base model, `of_weakest` the decrease of the sum of
/// squares by the weakest cause on the axis; both are whitened with the noise model of the pattern.
struct Pattern {
  Unexplained what;
  double of_base = 0, of_weakest = std::numeric_limits<double>::infinity();
};

/// Patterns in the residual of the drives and lines in the residual of the swing, strongest first.
/// @param losing encoders whose lost counts were restored: residuals that depend on them are explained
[[nodiscard]] std::vector<Pattern> residual_patterns(const WhitenedData& data, const Hypotheses& hypotheses,
                                                     const std::vector<LosingEncoder>& losing,
                                                     std::uint64_t seed);

/// True if the crane with these effects has an inner coordinate that oscillates freely. The effects then
/// produce a line of the spectrum themselves, and the start of the oscillation is free in each window.
[[nodiscard]] bool oscillates(const WhitenedData& data, const Effects& effects);

/// True if the pattern exceeds the thresholds of patterns beside these effects.
[[nodiscard]] bool counts_as_pattern(const Pattern& pattern, const Effects& effects);

/// Errors of the swing beside the best hypothesis that are not a random force.
struct SwingResidual {
  /// The largest first. The rms of each is larger than kLeastBeside of the largest change by an effect of the
  /// hypothesis. It is also larger than the permitted share of the motion. Beside a cause, a function of the
  /// swing or of its rate need only be larger than the noise of the sensor: the accuracy of the rig file does
  /// not explain its form, and the cause may be an attempt to describe it.
  std::vector<SwingPattern> patterns;
  std::vector<ShortForce> forces;  ///< at most one per output, the largest first
};

/// @param names_a_cause  true: an effect of the hypothesis is beyond the accuracy of the rig file
/// @param permitted share of the motion, > 0: accuracy of the rig file
[[nodiscard]] SwingResidual swing_residual(const WhitenedData& data, const Fitted& best, bool names_a_cause,
                                           double permitted, std::uint64_t seed);

}  // namespace crane::diagnosis
