#include "study/min_p.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <map>
#include <random>

#include "rules.hpp"
#include "study/blocks.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kSignFlips = static_cast<Index>(rules::kSignFlips.count());

double chi_square_p(double statistic, Index freedom) {
  return !(statistic > 0) ? 1.0 : boost::math::gamma_q(0.5 * static_cast<double>(freedom), 0.5 * statistic);
}

/// The directions B = by_block as (B'B)^(-1/2) B', up to a rotation: the sum of squares of their sums over
/// the blocks is chi-square. The first one has the sign of the first direction.
MatrixXd standardised(const MatrixXd& by_block) {
  MatrixXd products = by_block.transpose() * by_block;
  products.diagonal() += 1e-9 * products.diagonal() + Eigen::VectorXd::Constant(products.rows(), 1e-12);
  return products.llt().matrixL().solve(by_block.transpose());
}

/// Statistic by column; 0 for directions that are not finite. @param sums  of standardised directions, over
/// the blocks
Eigen::RowVectorXd statistics(const MatrixXd& sums, bool one_sided) {
  Eigen::RowVectorXd all = sums.colwise().squaredNorm();
  if (one_sided) all = (sums.row(0).array() > 0).select(all, 0.0);
  return (all.array() > 0).select(all, 0.0);
}

}  // namespace

Directions beside_known(const BlockScores& both, Index fresh) {
  const Index old = both.curvature.cols() - fresh;
  Directions d{both.by_block.rightCols(fresh), both.curvature.bottomRightCorner(fresh, fresh)};
  if (old == 0) return d;
  const MatrixXd cross = both.curvature.topRightCorner(old, fresh);
  MatrixXd share(old, fresh);
  for (Index j = 0; j < fresh; ++j)
    share.col(j) = solve(both.curvature.topLeftCorner(old, old), cross.col(j));
  d.by_block -= both.by_block.leftCols(old) * share;
  d.curvature -= cross.transpose() * share;
  return d;
}

double statistic_of(const Directions& d) {
  return statistics(standardised(d.by_block).rowwise().sum(), d.one_sided)[0];
}

double p_value_of(const Directions& d, double statistic) {
  return chi_square_p(statistic, d.by_block.cols());
}

double p_value_of_smallest(const std::vector<Directions>& directions, double least, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Index blocks = directions.empty() ? 0 : directions[0].by_block.rows();
  MatrixXd signs(blocks, kSignFlips);
  for (Index f = 0; f < signs.cols(); ++f)
    for (Index b = 0; b < blocks; ++b) signs(b, f) = (random() & 1U) != 0U ? 1.0 : -1.0;
  // For each number of directions, the largest statistic has the smallest p value.
  std::map<Index, Eigen::RowVectorXd> largest;
  for (const Directions& d : directions) {
    const Eigen::RowVectorXd of_flips = statistics(standardised(d.by_block) * signs, d.one_sided);
    Eigen::RowVectorXd& most =
        largest.try_emplace(d.by_block.cols(), Eigen::RowVectorXd::Zero(of_flips.size())).first->second;
    most = most.cwiseMax(of_flips);
  }
  std::size_t as_small = 1;
  for (Index f = 0; f < signs.cols(); ++f)
    as_small += std::ranges::any_of(largest, [&](const auto& of_freedom) {
      return chi_square_p(of_freedom.second[f], of_freedom.first) <= least;
    });
  return static_cast<double>(as_small) / (kSignFlips + 1);
}

}  // namespace crane::diagnosis
