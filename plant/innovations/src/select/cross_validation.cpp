#include "select/cross_validation.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

std::vector<std::size_t> fold_of_value(const Problem& problem, const Blocks& blocks, std::size_t& folds) {
  const bool by_run = problem.runs.size() >= static_cast<std::size_t>(rule::kLeastRuns.value);
  folds = by_run ? problem.runs.size() : static_cast<std::size_t>(rule::kFolds.value);
  std::vector<std::size_t> fold;
  for (const std::size_t b : blocks.of_value)
    fold.push_back(by_run ? blocks.run_of_block[b] : (b / 2) % folds);
  return fold;
}

std::vector<double> limited(std::vector<double> d) {
  std::vector<double> size;
  for (const double x : d) size.push_back(std::abs(x));
  const auto place = size.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(size.size() - 1));
  std::nth_element(size.begin(), place, size.end());
  const double most = 2.5 * *place + 1e-9;
  for (double& x : d) x = std::clamp(x, -most, most);
  return d;
}

std::vector<double> resampled_sums(const std::vector<double>& by_block, std::uint64_t seed) {
  constexpr int kResamples = 4000;
  const std::vector<double> d = limited(by_block);
  std::mt19937_64 random{seed};
  std::uniform_int_distribution<std::size_t> pick{0, d.size() - 1};
  std::vector<double> sums(kResamples, 0);
  for (double& s : sums)
    for (std::size_t k = 0; k < d.size(); ++k) s += d[pick(random)];
  return sums;
}

}  // namespace

std::vector<double> cross_validated(const Problem& problem, const Fit& fit, const std::vector<Index>& free) {
  const Blocks blocks = blocks_of(problem);
  std::size_t folds = 0;
  const auto fold = fold_of_value(problem, blocks, folds);
  const Eigen::MatrixXd s = scores(problem, fit.at, free, fit.by_value);
  const auto n = static_cast<Eigen::Index>(free.size());
  std::vector<Eigen::MatrixXd> information(folds, Eigen::MatrixXd::Zero(n, n));
  std::vector<Eigen::VectorXd> gradient(folds, Eigen::VectorXd::Zero(n));
  for (Eigen::Index k = 0; k < s.rows(); ++k) {
    const std::size_t f = fold[static_cast<std::size_t>(k)];
    information[f] += s.row(k).transpose() * s.row(k);
    gradient[f] += s.row(k).transpose();
  }
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  for (const auto& i : information) all += i;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double scale = problem.table[free[static_cast<std::size_t>(i)]].scale;
    all(i, i) += (free[static_cast<std::size_t>(i)] >= kNoiseBegin ? 0.1 : 1e-4) / (scale * scale);
  }
  std::vector<double> held(fit.by_value.size(), 0);
  tbb::parallel_for(std::size_t{0}, folds, [&](std::size_t f) {
    const Eigen::VectorXd step = -(all - information[f]).ldlt().solve(gradient[f]);
    Hypothesis moved = fit.at;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const ParameterInfo& info = problem.table[free[i]];
      const double way = std::clamp(step[static_cast<Eigen::Index>(i)], -4 * info.scale, 4 * info.scale);
      moved.values[free[i]] = std::clamp(moved.values[free[i]] + way, info.low, info.high);
    }
    const auto l = log_likelihoods(problem, moved);
    for (std::size_t k = 0; k < held.size(); ++k)
      if (fold[k] == f) held[k] = l.empty() ? fit.by_value[k] - 1 : l[k];
  });
  return held;
}

double resampled_sum(const std::vector<double>& by_block, double level, std::uint64_t seed) {
  std::vector<double> sums = resampled_sums(by_block, seed);
  const auto place = sums.begin() + static_cast<std::ptrdiff_t>(level * static_cast<double>(sums.size() - 1));
  std::nth_element(sums.begin(), place, sums.end());
  return *place;
}

double share_positive(const std::vector<double>& by_block, std::uint64_t seed) {
  const std::vector<double> sums = resampled_sums(by_block, seed);
  return static_cast<double>(std::count_if(sums.begin(), sums.end(), [](double s) { return s > 0; })) /
         static_cast<double>(sums.size());
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

}  // namespace crane::innovations
