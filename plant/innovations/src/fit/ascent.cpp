#include "fit/ascent.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace crane::innovations {
namespace {

Fit evaluated(const Problem& problem, Hypothesis at) {
  Fit fit;
  fit.by_value = log_likelihoods(problem, at);
  fit.value = fit.by_value.empty() ? -1e300 : sum(fit.by_value) + log_prior(problem, at.values);
  fit.at = std::move(at);
  return fit;
}

struct Quadratic {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

Quadratic quadratic(const Problem& problem, const Fit& fit, const std::vector<Index>& free) {
  const Eigen::MatrixXd s = scores(problem, fit.at, free, fit.by_value);
  Quadratic q{s.colwise().sum().transpose(), s.transpose() * s};
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    Values moved = fit.at.values;
    moved[free[i]] += 1e-3;
    q.gradient[k] += (log_prior(problem, moved) - log_prior(problem, fit.at.values)) / 1e-3;
    const double scale = problem.table[free[i]].scale;
    q.hessian(k, k) += 1e-4 / (scale * scale) + (free[i] >= kNoiseBegin ? 0.03 : 0);
  }
  return q;
}

Hypothesis moved_by(const Problem& problem, const Hypothesis& from, const std::vector<Index>& free,
                    const Eigen::VectorXd& step, double stretch) {
  Hypothesis to = from;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const ParameterInfo& info = problem.table[free[i]];
    const double most = 4 * info.scale * std::max(1.0, 0.5 * stretch);
    const double way = std::clamp(stretch * step[static_cast<Eigen::Index>(i)], -most, most);
    to.values[free[i]] = std::clamp(from.values[free[i]] + way, info.low, info.high);
  }
  return to;
}

/// Parameters at a bound that the gradient pushes against do not take part in a step.
void hold_at_bounds(const Problem& problem, const Values& at, const std::vector<Index>& free, Quadratic& q) {
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const ParameterInfo& info = problem.table[free[i]];
    const bool held =
        (at[free[i]] <= info.low && q.gradient[k] < 0) || (at[free[i]] >= info.high && q.gradient[k] > 0);
    if (!held) continue;
    const double own = q.hessian(k, k);
    q.hessian.row(k).setZero(), q.hessian.col(k).setZero();
    q.hessian(k, k) = own, q.gradient[k] = 0;
  }
}

}  // namespace

Fit ascend(const Problem& problem, Hypothesis from, const std::vector<Index>& free, AscentLimits limits) {
  Fit best = evaluated(problem, std::move(from));
  double damping = 1e-3;
  for (int round = 0; round < limits.rounds && best.usable(); ++round) {
    Quadratic q = quadratic(problem, best, free);
    hold_at_bounds(problem, best.at.values, free, q);
    const double before = best.value;
    for (int attempt = 0; attempt < 5 && best.value <= before; ++attempt) {
      Eigen::MatrixXd damped = q.hessian;
      damped.diagonal() *= 1 + damping;
      const Eigen::VectorXd step = damped.ldlt().solve(q.gradient);
      const Hypothesis begin = best.at;
      for (double stretch = 1; stretch < 40; stretch *= 2.2) {
        Fit trial = evaluated(problem, moved_by(problem, begin, free, step, stretch));
        if (!(trial.value > best.value)) break;
        best = std::move(trial);
      }
      damping = best.value > before ? std::max(1e-4, damping / 5) : std::max(0.1, damping * 8);
    }
    if (best.value - before < limits.least_gain) break;
  }
  return best;
}

Sandwich sandwich(const Problem& problem, const Fit& fit, const std::vector<Index>& theta) {
  const auto n = static_cast<Eigen::Index>(theta.size());
  Sandwich result{Eigen::MatrixXd::Zero(n, n), 0};
  if (theta.empty() || !fit.usable()) return result;
  const Eigen::MatrixXd s = scores(problem, fit.at, theta, fit.by_value);
  const Blocks blocks = blocks_of(problem);
  Eigen::MatrixXd by_block = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(blocks.count), n);
  for (Eigen::Index k = 0; k < s.rows(); ++k)
    by_block.row(static_cast<Eigen::Index>(blocks.of_value[static_cast<std::size_t>(k)])) += s.row(k);
  Eigen::MatrixXd information = s.transpose() * s;
  for (std::size_t i = 0; i < theta.size(); ++i)
    information(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) +=
        1e-6 / std::pow(problem.table[theta[i]].scale, 2);
  const Eigen::MatrixXd inverse = information.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd outer = by_block.transpose() * by_block;
  result.penalty = (inverse * outer).trace();
  result.covariance = inverse * outer * inverse;
  return result;
}

}  // namespace crane::innovations
