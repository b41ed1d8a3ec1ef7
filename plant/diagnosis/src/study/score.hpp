#pragma once
/// Score tests of the candidates beside a hypothesis (C. R. Rao 1948; docs/diagnosis_method.md, 6).
#include <cstddef>
#include <cstdint>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
#include "crane/diagnosis/diagnosis.hpp"
#include "study/probe_slopes.hpp"
#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// Score test of one candidate in one shape.
struct Score {
  std::size_t candidate = 0;
  Shape shape;
  double statistic = 0;  ///< chi-square of the block-robust score
  double p_value = 1;    ///< of this candidate alone
  double gain = 0;       ///< predicted decrease of the loss; < 0 when the shape increases it
  double share = 0;      ///< gain / loss of the parts in which the candidate is visible
  std::vector<double> amounts;
  std::vector<std::vector<double>> starts;  ///< initial values for a fit
};

struct ScoreTable {
  /// Best shape of every candidate, in the order of the candidates.
  std::vector<Score> best;
  std::vector<Visibility> excitation;  ///< of each effect in these data; only for the base model
  double p_value = 1;                  ///< of the most significant candidate, by flipping signs of blocks
};

/// Tests every further candidate on the residuals `at`. @param seed  of the sign flips
/// @param known  slopes of earlier tests; receives those of this one
[[nodiscard]] ScoreTable score_test(const WhitenedData& data, const Effects& effects, const Evaluation& at,
                                    std::uint64_t seed, ProbeSlopes& known);
/// Shapes of a candidate. For a wave: the strongest lines of the missing force beside the effects.
[[nodiscard]] std::vector<Shape> shapes_of(const WhitenedData& data, const Candidate& candidate,
                                           const Effects& effects);

}  // namespace crane::diagnosis
