#include "study.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "parallel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSignFlips = 999;
constexpr int kMostRounds = 8;
/// Decrease of the loss that is not worth another round.
constexpr double kLeastGain = 0.3;

/// Long windows suit a load that nothing drives, short ones a drive whose friction forgets.
double window_s(const runtime::Rig& rig) { return rig.kind == runtime::RigKind::pendulum ? 10.0 : 2.0; }

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

double chi_square_p(double statistic, std::size_t freedom) {
  return statistic <= 0 ? 1.0 : boost::math::gamma_q(0.5 * static_cast<double>(freedom), 0.5 * statistic);
}

/// Scores of one set of directions, block by block.
struct BlockScores {
  MatrixXd by_block;   ///< block x direction: slope' residual
  MatrixXd curvature;  ///< slope' slope
};

BlockScores block_scores(const Problem& problem, const Fits& fits,
                         const std::vector<std::vector<VectorXd>>& slopes) {
  BlockScores scores;
  const std::size_t directions = slopes.size();
  const std::size_t blocks = visit_blocks(problem, 0, [](auto...) {});
  scores.by_block = MatrixXd::Zero(static_cast<Index>(blocks), static_cast<Index>(directions));
  scores.curvature = MatrixXd::Zero(static_cast<Index>(directions), static_cast<Index>(directions));
  for (std::size_t i = 0; i < directions; ++i) {
    if (slopes[i].empty()) continue;
    visit_blocks(problem, 0, [&](std::size_t w, std::size_t block, Index row) {
      scores.by_block(static_cast<Index>(block), static_cast<Index>(i)) +=
          slopes[i][w][row] * fits[w].residual[row];
    });
    for (std::size_t j = 0; j <= i; ++j) {
      if (slopes[j].empty()) continue;
      double product = 0;
      for (std::size_t w = 0; w < fits.size(); ++w) product += slopes[i][w].dot(slopes[j][w]);
      scores.curvature(static_cast<Index>(i), static_cast<Index>(j)) = product;
      scores.curvature(static_cast<Index>(j), static_cast<Index>(i)) = product;
    }
  }
  return scores;
}

BlockScores joined(const BlockScores& a, const BlockScores& b) {
  BlockScores both;
  both.by_block.resize(a.by_block.rows() + b.by_block.rows(), std::max(a.by_block.cols(), b.by_block.cols()));
  both.by_block.setZero();
  if (a.by_block.size() > 0) both.by_block.topRows(a.by_block.rows()) = a.by_block;
  if (b.by_block.size() > 0) both.by_block.bottomRows(b.by_block.rows()) = b.by_block;
  both.curvature = a.curvature + b.curvature;
  return both;
}

/// Directions of effects already there are projected out of the new ones.
struct Directions {
  MatrixXd by_block, curvature;
};

/// Solves with a pinch of ridge: two probes may look alike.
VectorXd solve(const MatrixXd& h, const VectorXd& g) {
  MatrixXd regular = h;
  regular.diagonal() += 1e-9 * h.diagonal() + VectorXd::Constant(h.rows(), 1e-12);
  return regular.ldlt().solve(g);
}

double statistic_of(const MatrixXd& by_block, const VectorXd& signs, bool one_sided) {
  const VectorXd sum = by_block.transpose() * signs;
  if (one_sided && sum[0] <= 0) return 0;
  const MatrixXd variance = by_block.transpose() * by_block;
  const VectorXd solved = solve(variance, sum);
  return std::max(0.0, sum.dot(solved));
}

}  // namespace

double sum(const Blocks& blocks) { return std::accumulate(blocks.begin(), blocks.end(), 0.0); }

Blocks blocks_of(const Problem& problem, const Fits& fits) {
  Blocks blocks(visit_blocks(problem, 0, [](auto...) {}), 0.0);
  visit_blocks(problem, 0, [&](std::size_t w, std::size_t block, Index row) {
    blocks[block] += fits[w].residual[row] * fits[w].residual[row];
  });
  return blocks;
}

Study::Study(const runtime::Rig& rig, const Runs& train, const Runs& test)
    : base_{rig.plant, rig.terms},
      natural_radps_(std::sqrt(rig.plant.gravity_mps2 / rig.start.position[plant::kHoist])),
      candidates_(candidates_for(rig, train)) {
  const double length_s = window_s(rig);
  train_drive_ = std::make_unique<Problem>(train, Part::drive, length_s);
  train_load_ = std::make_unique<Problem>(train, Part::load, length_s);
  test_drive_ = std::make_unique<Problem>(test, Part::drive, length_s);
  test_load_ = std::make_unique<Problem>(test, Part::load, length_s);
}

Crane Study::with(const Effects& effects) const {
  Crane crane = base_;
  for (const Effect& effect : effects) crane.terms.push_back(effect.candidate->setting(effect.values));
  return crane;
}

namespace {

Evaluation summed(const Problem& drive, const Problem& load, Fits of_drive, Fits of_load) {
  Evaluation result;
  result.drive = std::move(of_drive);
  result.load = std::move(of_load);
  result.blocks = blocks_of(drive, result.drive);
  const Blocks more = blocks_of(load, result.load);
  result.blocks.insert(result.blocks.end(), more.begin(), more.end());
  result.loss = sum(result.blocks);
  return result;
}

Fits fit_of(const Problem& problem, const Crane& crane) {
  return problem.empty() ? Fits{} : problem.fit(crane);
}

}  // namespace

void Study::learn_disturbance() {
  for (const auto& [train, test] :
       {std::pair{train_drive_.get(), test_drive_.get()}, {train_load_.get(), test_load_.get()}}) {
    if (train->empty()) continue;
    train->learn_disturbance(base_, natural_radps_);
    if (!test->empty()) test->whiten_like(*train, base_);
  }
  base_train_ =
      summed(*train_drive_, *train_load_, fit_of(*train_drive_, base_), fit_of(*train_load_, base_));
  base_test_ = summed(*test_drive_, *test_load_, fit_of(*test_drive_, base_), fit_of(*test_load_, base_));
}

Evaluation Study::evaluate(const Problem& drive, const Problem& load, const Effects& effects,
                           const Evaluation& near) const {
  const Crane crane = with(effects);
  bool in_drive = false, in_load = false;
  for (const Effect& effect : effects) {
    in_drive = in_drive || effect.candidate->drive;
    in_load = in_load || effect.candidate->load;
  }
  return summed(drive, load, in_drive ? drive.fit_near(crane, near.drive) : near.drive,
                in_load ? load.fit_near(crane, near.load) : near.load);
}

Evaluation Study::train(const Effects& effects) const {
  return evaluate(*train_drive_, *train_load_, effects, base_train_);
}
Evaluation Study::test(const Effects& effects) const {
  return evaluate(*test_drive_, *test_load_, effects, base_test_);
}

/// Slopes of the outputs with every value of the effects.
struct Study::Slopes {
  std::vector<std::vector<VectorXd>> drive, load;  ///< by value; empty where it does not show
};

Study::Slopes Study::slopes(const Effects& effects, const Evaluation& at) const {
  Slopes result;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const Candidate& candidate = *effects[e].candidate;
    for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
      const FreeParameter& p = candidate.parameters[i];
      Effects moved = effects;
      double& value = moved[e].values[i];
      const double step = value + p.step <= p.high ? p.step : -p.step;
      value += 0.3 * step;
      const Crane crane = with(moved);
      result.drive.push_back(candidate.drive && !train_drive_->empty()
                                 ? train_drive_->change(crane, at.drive, 0.3 * step)
                                 : std::vector<VectorXd>{});
      result.load.push_back(candidate.load && !train_load_->empty()
                                ? train_load_->change(crane, at.load, 0.3 * step)
                                : std::vector<VectorXd>{});
    }
  }
  return result;
}

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

namespace {

struct Flat {
  std::vector<const FreeParameter*> parameters;
  VectorXd values;
};

Flat flatten(const Effects& effects) {
  Flat flat;
  std::vector<double> values;
  for (const Effect& effect : effects) {
    for (const FreeParameter& p : effect.candidate->parameters) flat.parameters.push_back(&p);
    values.insert(values.end(), effect.values.begin(), effect.values.end());
  }
  flat.values = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
  return flat;
}

Effects unflatten(Effects effects, const VectorXd& values) {
  Index i = 0;
  for (Effect& effect : effects)
    for (double& value : effect.values) value = values[i++];
  return effects;
}

/// Damped step inside the bounds; a value at its bound that wants out stays there.
VectorXd bounded_step(const MatrixXd& h, const VectorXd& g, const Flat& flat, double damping) {
  std::vector<Index> active;
  for (Index i = 0; i < flat.values.size(); ++i) active.push_back(i);
  VectorXd step = VectorXd::Zero(flat.values.size());
  for (int round = 0; round < 4 && !active.empty(); ++round) {
    const auto n = static_cast<Index>(active.size());
    MatrixXd reduced(n, n);
    VectorXd pull(n);
    for (Index i = 0; i < n; ++i) {
      pull[i] = g[active[static_cast<std::size_t>(i)]];
      for (Index j = 0; j < n; ++j)
        reduced(i, j) = h(active[static_cast<std::size_t>(i)], active[static_cast<std::size_t>(j)]);
    }
    reduced.diagonal() *= 1 + damping;
    const VectorXd moved = solve(reduced, pull);
    step.setZero();
    std::vector<Index> free;
    for (Index i = 0; i < n; ++i) {
      const Index at = active[static_cast<std::size_t>(i)];
      const FreeParameter& p = *flat.parameters[static_cast<std::size_t>(at)];
      const double wanted = flat.values[at] + moved[i], kept = std::clamp(wanted, p.low, p.high);
      step[at] = kept - flat.values[at];
      if (kept == wanted || step[at] != 0) free.push_back(at);
    }
    if (free.size() == active.size()) break;
    active = free;
  }
  return step;
}

}  // namespace

Fitted Study::fit(Effects effects) const {
  Fitted best;
  best.effects = effects;
  best.train = train(effects);
  double damping = 1e-3;
  MatrixXd information, variance;
  for (int round = 0; round < kMostRounds; ++round) {
    const Slopes slope = slopes(best.effects, best.train);
    const BlockScores both = joined(block_scores(*train_drive_, best.train.drive, slope.drive),
                                    block_scores(*train_load_, best.train.load, slope.load));
    information = both.curvature;
    variance = both.by_block.transpose() * both.by_block;
    const VectorXd pull = both.by_block.colwise().sum().transpose();
    const Flat flat = flatten(best.effects);
    bool better = false;
    double gained = 0;
    for (int attempt = 0; attempt < 5 && !better; ++attempt) {
      const VectorXd step = bounded_step(information, pull, flat, damping);
      if (step.norm() == 0) break;
      const Effects moved = unflatten(best.effects, flat.values + step);
      const Evaluation found = evaluate(*train_drive_, *train_load_, moved, best.train);
      if (found.loss < best.train.loss) {
        gained = best.train.loss - found.loss;
        best.effects = moved;
        best.train = found;
        damping = std::max(1e-6, damping * 0.2);
        better = true;
      } else {
        damping = std::max(damping, 1e-4) * 8;
      }
    }
    if (!better || gained < kLeastGain) break;
  }
  const MatrixXd inverse = information.completeOrthogonalDecomposition().pseudoInverse();
  const MatrixXd covariance = inverse * variance * inverse;
  for (Index i = 0; i < covariance.rows(); ++i)
    best.std_dev.push_back(std::sqrt(std::max(0.0, covariance(i, i))));
  best.parameters = best.std_dev.size();
  best.test = test(best.effects);
  return best;
}

}  // namespace crane::diagnosis
