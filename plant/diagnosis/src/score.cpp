#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <random>

#include "blocks.hpp"
#include "parallel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSignFlips = 999;

double chi_square_p(double statistic, std::size_t freedom) {
  return statistic <= 0 ? 1.0 : boost::math::gamma_q(0.5 * static_cast<double>(freedom), 0.5 * statistic);
}

double statistic_of(const MatrixXd& by_block, const VectorXd& signs, bool one_sided) {
  const VectorXd sum = by_block.transpose() * signs;
  if (one_sided && sum[0] <= 0) return 0;
  const MatrixXd variance = by_block.transpose() * by_block;
  const VectorXd solved = solve(variance, sum);
  return std::max(0.0, sum.dot(solved));
}

}  // namespace

ScoreTable Study::score(const Effects& effects, const Evaluation& at, std::uint64_t seed) const {
  struct Place {
    std::size_t candidate, shape;
  };
  std::vector<Place> places;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const bool there = std::any_of(effects.begin(), effects.end(),
                                   [&](const Effect& effect) { return effect.candidate == &candidates_[c]; });
    if (!there)
      for (std::size_t s = 0; s < candidates_[c].shapes.size(); ++s) places.push_back({c, s});
  }
  const Slopes known = slopes(effects, at);
  std::vector<MatrixXd> by_block(places.size());
  std::vector<Score> scores(places.size());
  parallel_for(places.size(), [&](std::size_t i) {
    const Candidate& candidate = candidates_[places[i].candidate];
    const Shape& shape = candidate.shapes[places[i].shape];
    Slopes all = known;
    for (std::size_t p = 0; p < shape.probes.size(); ++p) {
      Crane crane = with(effects);
      crane.terms.push_back(shape.probes[p]);
      all.drive.push_back(candidate.drive && !train_drive_->empty()
                              ? train_drive_->change(crane, at.drive, shape.amounts[p])
                              : std::vector<VectorXd>{});
      all.load.push_back(candidate.load && !train_load_->empty()
                             ? train_load_->change(crane, at.load, shape.amounts[p])
                             : std::vector<VectorXd>{});
    }
    const BlockScores both = joined(block_scores(*train_drive_, at.drive, all.drive),
                                    block_scores(*train_load_, at.load, all.load));
    const auto old = static_cast<Index>(known.drive.size()), fresh = static_cast<Index>(shape.probes.size());
    MatrixXd directions = both.by_block.rightCols(fresh),
             curvature = both.curvature.bottomRightCorner(fresh, fresh);
    if (old > 0) {
      const MatrixXd cross = both.curvature.topRightCorner(old, fresh);
      MatrixXd share(old, fresh);
      for (Index j = 0; j < fresh; ++j)
        share.col(j) = solve(both.curvature.topLeftCorner(old, old), cross.col(j));
      directions -= both.by_block.leftCols(old) * share;
      curvature -= cross.transpose() * share;
    }
    Score& score = scores[i];
    score.candidate = places[i].candidate;
    score.shape = places[i].shape;
    const VectorXd total = directions.colwise().sum().transpose();
    const VectorXd amounts = solve(curvature, total);
    score.amounts.assign(amounts.data(), amounts.data() + amounts.size());
    score.gain = candidate.one_sided && total[0] <= 0 ? 0 : std::max(0.0, total.dot(amounts));
    score.statistic = statistic_of(directions, VectorXd::Ones(directions.rows()), candidate.one_sided);
    score.p_value = chi_square_p(score.statistic, static_cast<std::size_t>(fresh));
    by_block[i] = std::move(directions);
  });

  ScoreTable table;
  double least = 1;
  for (const Score& score : scores) least = std::min(least, score.p_value);
  // How often does nothing but luck give a p-value as small as the smallest?
  std::mt19937_64 random(seed);
  std::vector<VectorXd> signs(kSignFlips);
  const Index blocks = by_block.empty() ? 0 : by_block[0].rows();
  for (VectorXd& flip : signs) {
    flip.resize(blocks);
    for (Index b = 0; b < blocks; ++b) flip[b] = (random() & 1U) != 0U ? 1.0 : -1.0;
  }
  std::vector<double> smallest(kSignFlips, 1.0);
  parallel_for(kSignFlips, [&](std::size_t f) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double statistic =
          statistic_of(by_block[i], signs[f], candidates_[places[i].candidate].one_sided);
      smallest[f] =
          std::min(smallest[f], chi_square_p(statistic, static_cast<std::size_t>(by_block[i].cols())));
    }
  });
  std::size_t as_small = 1;
  for (const double value : smallest) as_small += value <= least ? 1 : 0;
  table.p_value = static_cast<double>(as_small) / (kSignFlips + 1);
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const Score* best = nullptr;
    for (const Score& score : scores)
      if (score.candidate == c && (best == nullptr || score.gain > best->gain)) best = &score;
    if (best != nullptr) table.best.push_back(*best);
  }
  return table;
}

}  // namespace crane::diagnosis
