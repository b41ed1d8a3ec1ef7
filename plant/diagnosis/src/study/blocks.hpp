#pragma once
/// Scores block by block: blocks are what is resampled.
#include "study/study.hpp"

namespace crane::diagnosis {

/// Changes of the whitened outputs per unit, by value of the effects and window or piece; empty where it does
/// not show.
struct Study::Slopes {
  std::vector<std::vector<Eigen::VectorXd>> drive, equation_error, load;
};

/// Scores of a set of directions.
struct BlockScores {
  Eigen::MatrixXd by_block;                   ///< block x direction: slope' weighted residual
  Eigen::MatrixXd curvature;                  ///< slope' weighted slope
  std::vector<Eigen::MatrixXd> curvature_of;  ///< the same by block
  /// By direction, of all blocks.
  [[nodiscard]] Eigen::VectorXd pull() const { return by_block.colwise().sum().transpose(); }
};
[[nodiscard]] BlockScores block_scores(const Problem& problem, const Fits& fits,
                                       const std::vector<std::vector<Eigen::VectorXd>>& slopes,
                                       Loss loss = Loss::robust);
/// Adds the scores of residuals that belong to `blocks`.
void add_scores(const std::vector<std::size_t>& blocks, const std::vector<Eigen::VectorXd>& residuals,
                const std::vector<std::vector<Eigen::VectorXd>>& slopes, Loss loss, BlockScores& scores);
/// Blocks of `a`, then those of `b`.
[[nodiscard]] BlockScores joined(const BlockScores& a, const BlockScores& b);

/// What every block costs more when the values are fitted without it, to second order (the infinitesimal
/// jackknife; its sum is the penalty of K. Takeuchi, Suri-Kagaku 153 (1976) 12, with leverage).
[[nodiscard]] Blocks left_out(const BlockScores& at);
/// Of the innovations, by block.
[[nodiscard]] Blocks log_variances_of(const Problem& problem);

/// h x = g with a pinch of ridge: two directions may look alike.
[[nodiscard]] Eigen::VectorXd solve(const Eigen::MatrixXd& h, const Eigen::VectorXd& g);

}  // namespace crane::diagnosis
