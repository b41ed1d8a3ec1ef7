#pragma once
/// Sensitivity of the data to each candidate, independent of the residual: the information of the score test
/// (C. R. Rao, Proc. Cambridge Phil. Soc. 44 (1948) 50) along the slopes of the candidate, and the cosine
/// between the slopes of two candidates. The slopes are whitened, with marginal starts.
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {

struct Score;
struct BlockScores;

/// One probe of one candidate.
struct Direction {
  std::size_t place = 0;  ///< of the scores
  std::size_t probe = 0;  ///< of its shape
};

/// Probability that an effect of the least size is found.
inline constexpr double kPower = 0.9;
/// Cosine above which two candidates can hardly be distinguished: distinguishing them needs 1 / sqrt(1 -
/// cosine^2) = 2.3 times the least size.
inline constexpr double kAlike = 0.9;

/// Directions of each candidate: the probes of the shape with the largest information.
/// @param information by place, of each probe
[[nodiscard]] std::vector<Direction> strongest_directions(
    const std::vector<Score>& places, const std::vector<std::vector<double>>& information);

/// @param at scores of the directions, in their order
[[nodiscard]] std::vector<Visibility> visibility_of(const std::vector<Candidate>& candidates,
                                                    const std::vector<Score>& places,
                                                    const std::vector<Direction>& directions,
                                                    const BlockScores& at);

}  // namespace crane::diagnosis
