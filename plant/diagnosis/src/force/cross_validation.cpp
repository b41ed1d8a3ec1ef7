#include "force/cross_validation.hpp"

#include <algorithm>
#include <numeric>
#include <random>

namespace crane::diagnosis {

double ridge_of(const NormalEquations& all) {
  return 1e-3 * all.hessian.trace() / static_cast<double>(all.score.size()) + 1e-12;
}

double gain_of_folds(std::span<const double, kFolds> gains) {
  const auto agreeing = std::ranges::count_if(gains, [](double gain) { return gain > 0; });
  return agreeing + 1 >= static_cast<std::ptrdiff_t>(kFolds)
             ? std::accumulate(gains.begin(), gains.end(), 0.0)
             : 0;
}

std::vector<Eigen::VectorXd> random_signs(Eigen::Index count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Eigen::VectorXd> flips(kFlips, Eigen::VectorXd::Ones(count));
  for (Eigen::VectorXd& flip : flips)
    for (double& sign : flip) sign = (random() & 1U) != 0U ? 1.0 : -1.0;
  return flips;
}

}  // namespace crane::diagnosis
