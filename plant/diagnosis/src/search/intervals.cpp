#include "search/intervals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

#include "search/rough_interval.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kResamplings = 400;
/// The profile ends where the loss exceeds the loss of the fit by more.
constexpr double kFarLoss = 60;
/// Points of the profile, in standard deviations of the sandwich covariance.
constexpr std::array kDistances{0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};
/// Decrease of the loss above which another value replaces the fitted value.
constexpr double kBetter = 1;
constexpr int kAttempts = 3;

/// Losses of the blocks along one direction of the values, by distance.
using Profile = std::map<double, Blocks>;

double value_of(const Effects& effects, Index number) {
  for (const Effect& effect : effects) {
    const auto count = static_cast<Index>(effect.values.size());
    if (number < count) return effect.values[static_cast<std::size_t>(number)];
    number -= count;
  }
  return 0;
}

/// Evaluates outwards in both directions until the loss exceeds kFarLoss or the value reaches its bound.
Profile profile_of(const Study& study, const Fitted& fitted, const VectorXd& direction, Index value) {
  Profile profile{{0, fitted.train.blocks}};
  for (const double side : {-1.0, 1.0}) {
    double last = value_of(fitted.effects, value);
    for (const double distance : kDistances) {
      const Effects there = moved(fitted.effects, side * distance * direction);
      if (value_of(there, value) == last) break;
      last = value_of(there, value);
      const Evaluation found = study.train(there, fitted.train);
      profile.emplace(side * distance, found.blocks);
      if (found.loss > fitted.train.loss + kFarLoss) break;
    }
  }
  return profile;
}

/// Minimum of the parabola through the smallest loss and its two neighbours.
double least_at(const std::vector<double>& at, const std::vector<double>& loss) {
  const auto k = static_cast<std::size_t>(std::min_element(loss.begin(), loss.end()) - loss.begin());
  if (k == 0 || k + 1 == loss.size()) return at[k];
  const double left = (loss[k] - loss[k - 1]) / (at[k] - at[k - 1]);
  const double right = (loss[k + 1] - loss[k]) / (at[k + 1] - at[k]);
  const double bend = (right - left) / (0.5 * (at[k + 1] - at[k - 1]));
  if (!(bend > 0)) return at[k];
  const double flat = 0.5 * (at[k - 1] + at[k]) - left / bend;
  return std::clamp(flat, at[k - 1], at[k + 1]);
}

/// Root mean square of the minimum of the profile over resamples of the blocks, about 0.
double spread(const Profile& profile, std::uint64_t seed) {
  std::vector<double> at;
  for (const auto& [t, blocks] : profile) at.push_back(t);
  const std::size_t count = profile.at(0).size();
  std::mt19937_64 random(seed);
  double squares = 0;
  for (int i = 0; i < kResamplings; ++i) {
    std::vector<double> loss(at.size(), 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t block = static_cast<std::size_t>(random() % count);
      std::size_t t = 0;
      for (const auto& [place, blocks] : profile) loss[t++] += blocks[block];
    }
    squares += std::pow(least_at(at, loss), 2) / kResamplings;
  }
  return std::sqrt(squares);
}

/// Largest decrease of the loss on the profile, and its distance from the fit.
struct Best {
  double gain = 0, at = 0;
};
Best best_of(const Profile& profile) {
  const double here = sum(profile.at(0));
  Best best;
  for (const auto& [t, blocks] : profile)
    if (here - sum(blocks) > best.gain) best = {here - sum(blocks), t};
  return best;
}

}  // namespace

Fitted with_intervals(const Study& study, Fitted fitted, std::uint64_t seed) {
  for (int attempt = 0;; ++attempt) {
    const bool last = attempt + 1 == kAttempts;
    const LossParabola parabola = fit_loss_parabola(study, fitted);
    Effects better;
    if (!last && parabola.best_loss < fitted.train.loss - kBetter) better = parabola.best;
    std::vector<double> std_dev = fitted.std_dev;
    for (Index i = 0; i < fitted.covariance.cols() && better.empty(); ++i) {
      double& own = std_dev[static_cast<std::size_t>(i)];
      if (!(own > 0)) continue;
      const VectorXd direction = fitted.covariance.col(i) / own;
      const Profile profile = profile_of(study, fitted, direction, i);
      const Best best = best_of(profile);
      if (!last && best.gain > kBetter) better = moved(fitted.effects, best.at * direction);
      own = std::max({own * spread(profile, seed + static_cast<std::uint64_t>(i)), fitted.by_noise[i],
                      parabola.std_dev[i]});
    }
    if (better.empty()) {
      fitted.std_dev = std::move(std_dev);
      return fitted;
    }
    fitted = study.fit(better);
  }
}

}  // namespace crane::diagnosis
