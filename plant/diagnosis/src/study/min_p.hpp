#pragma once
/// Score test of one candidate, and min-P test of the most significant of all candidates.
#include <Eigen/Dense>
#include <cstdint>
#include <vector>

namespace crane::diagnosis {

struct BlockScores;

/// Directions of one candidate in one shape by block, with the directions of the known effects projected out.
struct Directions {
  Eigen::MatrixXd by_block, curvature;
  bool one_sided = false;
};

/// The last `fresh` directions of `both`, with all earlier directions projected out.
[[nodiscard]] Directions beside_known(const BlockScores& both, Eigen::Index fresh);

/// Chi-square distributed if the candidate has no effect; 0 for directions that are not finite.
[[nodiscard]] double statistic_of(const Directions& directions);
/// p value of a statistic of these directions.
[[nodiscard]] double p_value_of(const Directions& directions, double statistic);

/// p value of the smallest p value `least`: share of random sign flips of the blocks, counting the data as
/// one of them, in which the smallest p value is at most `least`.
[[nodiscard]] double p_value_of_smallest(const std::vector<Directions>& directions, double least,
                                         std::uint64_t seed);

}  // namespace crane::diagnosis
