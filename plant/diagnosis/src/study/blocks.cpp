#include "study/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Calls visit(block, row index) for every row of every output of the windows.
template <class Visit>
std::size_t visit_blocks(const Problem& problem, std::size_t first_block, Visit&& visit) {
  std::size_t block = first_block;
  for (std::size_t w = 0; w < problem.windows().size(); ++w) {
    const Window& window = problem.windows()[w];
    const double period_s = problem.runs()[window.run].run.period_s;
    const auto count = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::lround(static_cast<double>(window.rows) * period_s / kBlock_s)));
    for (std::size_t output = 0; output < problem.outputs().size(); ++output)
      for (std::size_t k = 0; k < window.rows; ++k)
        visit(w, block + k * count / window.rows, static_cast<Index>(output * window.rows + k));
    block += count;
  }
  return block;
}

}  // namespace

BlockScores block_scores(const Problem& problem, const Fits& fits,
                         const std::vector<std::vector<VectorXd>>& slopes, Loss loss) {
  BlockScores scores;
  const std::size_t directions = slopes.size();
  const std::size_t blocks = visit_blocks(problem, 0, [](auto...) {});
  scores.by_block = MatrixXd::Zero(static_cast<Index>(blocks), static_cast<Index>(directions));
  scores.curvature = MatrixXd::Zero(static_cast<Index>(directions), static_cast<Index>(directions));
  scores.curvature_of.assign(blocks, scores.curvature);
  std::vector<VectorXd> weights;
  for (const WindowFit& fit : fits) weights.push_back(weights_of(fit.residual, loss));
  for (std::size_t i = 0; i < directions; ++i) {
    if (slopes[i].empty()) continue;
    visit_blocks(problem, 0, [&](std::size_t w, std::size_t block, Index row) {
      scores.by_block(static_cast<Index>(block), static_cast<Index>(i)) +=
          slopes[i][w][row] * weights[w][row] * fits[w].residual[row];
    });
    for (std::size_t j = 0; j <= i; ++j) {
      if (slopes[j].empty()) continue;
      const auto row = static_cast<Index>(i), column = static_cast<Index>(j);
      visit_blocks(problem, 0, [&](std::size_t w, std::size_t block, Index k) {
        scores.curvature_of[block](row, column) += slopes[i][w][k] * weights[w][k] * slopes[j][w][k];
      });
      for (MatrixXd& of_block : scores.curvature_of) {
        of_block(column, row) = of_block(row, column);
        scores.curvature(row, column) += of_block(row, column);
      }
      scores.curvature(column, row) = scores.curvature(row, column);
    }
  }
  return scores;
}

void add_scores(const std::vector<std::size_t>& blocks, const std::vector<VectorXd>& residuals,
                const std::vector<std::vector<VectorXd>>& slopes, Loss loss, BlockScores& scores) {
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const VectorXd weights = weights_of(residuals[k], loss);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      if (slopes[i].empty()) continue;
      const VectorXd weighted = weights.cwiseProduct(slopes[i][k]);
      const auto column = static_cast<Index>(i);
      scores.by_block(static_cast<Index>(blocks[k]), column) += weighted.dot(residuals[k]);
      for (std::size_t j = 0; j <= i; ++j) {
        if (slopes[j].empty()) continue;
        const auto row = static_cast<Index>(j);
        const double product = weighted.dot(slopes[j][k]);
        for (MatrixXd* curvature : {&scores.curvature, &scores.curvature_of[blocks[k]]}) {
          (*curvature)(row, column) += product;
          (*curvature)(column, row) = (*curvature)(row, column);
        }
      }
    }
  }
}

BlockScores joined(const BlockScores& a, const BlockScores& b) {
  BlockScores both;
  both.by_block.resize(a.by_block.rows() + b.by_block.rows(), std::max(a.by_block.cols(), b.by_block.cols()));
  both.by_block.setZero();
  if (a.by_block.size() > 0) both.by_block.topRows(a.by_block.rows()) = a.by_block;
  if (b.by_block.size() > 0) both.by_block.bottomRows(b.by_block.rows()) = b.by_block;
  both.curvature = a.curvature + b.curvature;
  both.curvature_of = a.curvature_of;
  both.curvature_of.insert(both.curvature_of.end(), b.curvature_of.begin(), b.curvature_of.end());
  return both;
}

BlockScores leading(const BlockScores& scores, Index directions) {
  BlockScores first{
      scores.by_block.leftCols(directions), scores.curvature.topLeftCorner(directions, directions), {}};
  for (const MatrixXd& of_block : scores.curvature_of)
    first.curvature_of.emplace_back(of_block.topLeftCorner(directions, directions));
  return first;
}

Blocks left_out(const BlockScores& at) {
  Blocks cost(static_cast<std::size_t>(at.by_block.rows()), 0.0);
  for (std::size_t block = 0; block < cost.size(); ++block) {
    const VectorXd gradient = at.by_block.row(static_cast<Index>(block)).transpose();
    cost[block] = 2 * gradient.dot(solve(at.curvature - at.curvature_of[block], gradient));
  }
  return cost;
}

VectorXd solve(const MatrixXd& h, const VectorXd& g) {
  MatrixXd regular = h;
  regular.diagonal() += 1e-9 * h.diagonal() + VectorXd::Constant(h.rows(), 1e-12);
  return regular.ldlt().solve(g);
}

Blocks log_variances_of(const Problem& problem) {
  Blocks blocks(visit_blocks(problem, 0, [](auto...) {}), 0.0);
  visit_blocks(problem, 0, [&](std::size_t w, std::size_t block, Index row) {
    blocks[block] += problem.log_variance(w, static_cast<std::size_t>(row));
  });
  return blocks;
}

double sum(const Blocks& blocks) { return std::accumulate(blocks.begin(), blocks.end(), 0.0); }

Blocks blocks_of(const Problem& problem, const Fits& fits) {
  Blocks blocks(visit_blocks(problem, 0, [](auto...) {}), 0.0);
  visit_blocks(problem, 0, [&](std::size_t w, std::size_t block, Index row) {
    const double price = fits[w].start_log_determinant / static_cast<double>(fits[w].residual.size());
    blocks[block] += loss_of(fits[w].residual[row]) + price;
  });
  return blocks;
}

}  // namespace crane::diagnosis
