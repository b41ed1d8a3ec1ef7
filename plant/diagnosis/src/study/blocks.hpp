#pragma once
/// Scores by block. Blocks are the units of resampling.
#include <Eigen/Dense>
#include <vector>

#include "robust.hpp"
#include "study/hypothesis.hpp"

namespace crane::diagnosis {

/// Scores of a set of directions.
struct BlockScores {
  Eigen::MatrixXd by_block;                   ///< block x direction: slope' weighted residual
  Eigen::MatrixXd curvature;                  ///< slope' weighted slope
  std::vector<Eigen::MatrixXd> curvature_of;  ///< the same by block
  /// By direction, sum over all blocks: -1/2 of the gradient of the loss.
  [[nodiscard]] Eigen::VectorXd gradient() const { return by_block.colwise().sum().transpose(); }
};
[[nodiscard]] BlockScores block_scores(const Problem& problem, const Fits& fits,
                                       const std::vector<std::vector<Eigen::VectorXd>>& slopes,
                                       Loss loss = Loss::robust);
/// Adds the scores of residuals that belong to `blocks`.
void add_scores(const std::vector<std::size_t>& blocks, const std::vector<Eigen::VectorXd>& residuals,
                const std::vector<std::vector<Eigen::VectorXd>>& slopes, Loss loss, BlockScores& scores);
/// Scores and curvatures of the first `directions` directions.
[[nodiscard]] BlockScores leading(const BlockScores& scores, Eigen::Index directions);
/// Blocks of `a`, then those of `b`.
[[nodiscard]] BlockScores joined(const BlockScores& a, const BlockScores& b);

/// Increase of the loss of each block b when the fit omits the block, to first order in the change of the
/// parameters: 2 g_b' (H - H_b)^-1 g_b. With H instead of
/// H - H_b, the term would be that of the infinitesimal jackknife. The sum is the
/// penalty of K. Takeuchi, Suri-Kagaku 153 (1976) 12, with leverage.
[[nodiscard]] Blocks left_out(const BlockScores& at);
/// By block: number of the blocks after it, in its run, that begin within `time_s` of its end, rounded.
[[nodiscard]] std::vector<std::size_t> followers_within(const Problem& problem, double time_s);
/// Sum of ln f of the innovations, by block.
[[nodiscard]] Blocks log_variances_of(const Problem& problem);

/// Loss of each block.
[[nodiscard]] Blocks blocks_of(const Problem& problem, const Fits& fits);

/// Solves h x = g. A small ridge keeps h regular when two directions have the same effect.
[[nodiscard]] Eigen::VectorXd solve(const Eigen::MatrixXd& h, const Eigen::VectorXd& g);

}  // namespace crane::diagnosis
