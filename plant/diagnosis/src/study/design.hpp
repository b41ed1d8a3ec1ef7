#pragma once
/// What the data can show of the candidates, whatever they say: the information of the score test (C. R. Rao,
/// Proc. Cambridge Phil. Soc. 44 (1948) 50) along each candidate's change, and the cosine between two
/// changes, both whitened and with the starts of windows taken out.
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {

class Study;
struct Score;
struct BlockScores;

/// One way of one candidate to look.
struct Direction {
  std::size_t place = 0;  ///< of the scores
  std::size_t probe = 0;  ///< of its shape
};

/// Chance that an effect of the least size is found.
inline constexpr double kPower = 0.9;
/// Two changes of so much the same direction are hardly told apart: the size that is told from the other is
/// 1 / sqrt(1 - cosine^2) = 2.3 times the least that is found.
inline constexpr double kAlike = 0.9;

/// Directions in which the candidates are looked at: those of the shape with the largest information of each.
/// @param information by place, of each probe
[[nodiscard]] std::vector<Direction> strongest_directions(
    const std::vector<Score>& places, const std::vector<std::vector<double>>& information);

/// @param at scores of the directions, in their order
[[nodiscard]] std::vector<Visibility> visibility_of(const std::vector<Candidate>& candidates,
                                                    const std::vector<Score>& places,
                                                    const std::vector<Direction>& directions,
                                                    const BlockScores& at);

}  // namespace crane::diagnosis
