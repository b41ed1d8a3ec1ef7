#include "study/blocks.hpp"

#include <algorithm>
#include <cmath>

#include "parallel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rows of one output of a window that belong to one block.
struct BlockRows {
  std::size_t window = 0, block = 0;
  Index first = 0, count = 0;  ///< in the vector of all outputs
};

/// Number of blocks of a window.
std::size_t blocks_in(const Problem& problem, const Window& window) {
  const double seconds = static_cast<double>(window.rows) * problem.runs()[window.run].run.period_s;
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(seconds / kBlock_s)));
}

struct BlockRowsOf {
  std::vector<std::vector<BlockRows>> windows;
  std::size_t blocks = 0;
};

/// The blocks of a window divide its rows evenly.
BlockRowsOf block_rows_of(const Problem& problem) {
  BlockRowsOf all;
  for (std::size_t w = 0; w < problem.windows().size(); ++w) {
    const Window& window = problem.windows()[w];
    const std::size_t count = blocks_in(problem, window);
    std::vector<BlockRows>& of_window = all.windows.emplace_back();
    for (std::size_t output = 0; output < problem.outputs().size(); ++output)
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = (i * window.rows + count - 1) / count,
                          end = ((i + 1) * window.rows + count - 1) / count;
        of_window.push_back({w, all.blocks + i, static_cast<Index>(output * window.rows + first),
                             static_cast<Index>(end - first)});
      }
    all.blocks += count;
  }
  return all;
}

}  // namespace

BlockScores block_scores(const Problem& problem, const Fits& fits,
                         const std::vector<std::vector<VectorXd>>& slopes, Loss loss) {
  const BlockRowsOf rows = block_rows_of(problem);
  const auto directions = static_cast<Index>(slopes.size());
  BlockScores scores;
  scores.by_block = MatrixXd::Zero(static_cast<Index>(rows.blocks), directions);
  scores.curvature = MatrixXd::Zero(directions, directions);
  scores.curvature_of.assign(rows.blocks, scores.curvature);
  std::vector<Index> visible;
  for (Index i = 0; i < directions; ++i)
    if (!slopes[static_cast<std::size_t>(i)].empty()) visible.push_back(i);
  if (visible.empty()) return scores;
  parallel_for(rows.windows.size(), [&](std::size_t w) {
    const VectorXd root_weights = weights_of(fits[w].residual, loss).cwiseSqrt();
    const VectorXd residual = root_weights.cwiseProduct(fits[w].residual);
    MatrixXd all(residual.size(), static_cast<Index>(visible.size()));
    for (Index i = 0; i < all.cols(); ++i)
      all.col(i) = root_weights.cwiseProduct(
          slopes[static_cast<std::size_t>(visible[static_cast<std::size_t>(i)])][w]);
    for (const BlockRows& at : rows.windows[w]) {
      const auto part = all.middleRows(at.first, at.count);
      scores.by_block(static_cast<Index>(at.block), visible) +=
          part.transpose() * residual.segment(at.first, at.count);
      scores.curvature_of[at.block](visible, visible) += part.transpose() * part;
    }
  });
  for (const MatrixXd& of_block : scores.curvature_of) scores.curvature += of_block;
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

std::vector<std::size_t> followers_within(const Problem& problem, double time_s) {
  std::vector<std::size_t> followers;
  for (std::size_t w = 0; w < problem.windows().size();) {
    const std::size_t run = problem.windows()[w].run, first = followers.size();
    double duration_s = 0;
    for (; w < problem.windows().size() && problem.windows()[w].run == run; ++w) {
      duration_s += static_cast<double>(problem.windows()[w].rows) * problem.runs()[run].run.period_s;
      followers.resize(followers.size() + blocks_in(problem, problem.windows()[w]));
    }
    const std::size_t count = followers.size() - first;
    const auto most = static_cast<std::size_t>(std::lround(time_s * static_cast<double>(count) / duration_s));
    for (std::size_t i = 0; i < count; ++i) followers[first + i] = std::min(most, count - 1 - i);
  }
  return followers;
}

Blocks log_variances_of(const Problem& problem) {
  const BlockRowsOf rows = block_rows_of(problem);
  Blocks blocks(rows.blocks, 0.0);
  for (const std::vector<BlockRows>& of_window : rows.windows)
    for (const BlockRows& at : of_window)
      for (Index row = at.first; row < at.first + at.count; ++row)
        blocks[at.block] += problem.log_variance(at.window, static_cast<std::size_t>(row));
  return blocks;
}

Blocks blocks_of(const Problem& problem, const Fits& fits) {
  const BlockRowsOf rows = block_rows_of(problem);
  Blocks blocks(rows.blocks, 0.0);
  for (const std::vector<BlockRows>& of_window : rows.windows)
    for (const BlockRows& at : of_window) {
      const WindowFit& fit = fits[at.window];
      const double price = fit.start_log_determinant / static_cast<double>(fit.residual.size());
      for (Index row = at.first; row < at.first + at.count; ++row)
        blocks[at.block] += loss_of(fit.residual[row]) + price;
    }
  return blocks;
}

}  // namespace crane::diagnosis
