#include "search/intervals.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <random>

#include "rules.hpp"
#include "search/rough_interval.hpp"
#include "study/fit.hpp"
#include "study/uncertainty.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kResamplings = static_cast<int>(rules::kResamplings.count());
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
/// @param effects of the fit, then inaccuracies of the rig file @param direction of all of them
Profile profile_of(const WhitenedData& data, const Fitted& fitted, const Effects& effects,
                   const VectorXd& direction, Index value) {
  Profile profile{{0, fitted.train.blocks}};
  for (const double side : {-1.0, 1.0}) {
    double last = value_of(effects, value);
    for (const double distance : kDistances) {
      const Effects there = moved(effects, side * distance * direction);
      if (value_of(there, value) == last) break;
      last = value_of(there, value);
      const Evaluation found = data.evaluated(there, fitted.train);
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
/// @param bend increase of the loss that every resample contains, per squared distance
double spread(const Profile& profile, double bend, std::uint64_t seed) {
  std::vector<double> at;
  for (const auto& [t, blocks] : profile) at.push_back(t);
  const std::size_t count = profile.at(0).size();
  std::mt19937_64 random(seed);
  double squares = 0;
  for (int i = 0; i < kResamplings; ++i) {
    std::vector<double> loss;
    for (const double t : at) loss.push_back(bend * t * t);
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

/// Factor by which a 95 % interval of Student's distribution exceeds that of the normal distribution, for the
/// effective degrees of freedom of a combined uncertainty (JCGM 100:2008, G.4).
/// @param by_blocks standard deviation that is known with `freedom` only
/// @param total combined standard deviation; what exceeds `by_blocks` is known
double coverage_factor(double by_blocks, double total, double freedom) {
  constexpr double kNormal = 1.959964, kUpper = 0.975, kNormalFrom = 1e4;
  const double effective = freedom * std::pow(total / by_blocks, 4);
  if (!(effective < kNormalFrom)) return 1;
  return boost::math::quantile(boost::math::students_t(effective), kUpper) / kNormal;
}

double std_dev_of(const ValueUncertainty& value, double spread, double by_parabola) {
  // Slopes do not describe a loss with steps: the scatter of the minimum replaces the sandwich.
  const double by_blocks = std::max(by_parabola > 0 ? 0.0 : value.std_dev, spread);
  const double random = std::max({by_blocks, value.by_noise, by_parabola});
  const double total = std::hypot(random, value.systematic);
  return total > 0 ? total * coverage_factor(by_blocks, total, value.freedom) : 0;
}

/// The effects of a fit without the inaccuracies that follow them.
Effects first_of(const Effects& effects, std::size_t count) {
  return {effects.begin(), effects.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

Fitted with_intervals(const WhitenedData& data, Fitted fitted, std::uint64_t seed) {
  const Evaluation base = data.base();
  fitted = converged(data, std::move(fitted));
  for (int attempt = 0;; ++attempt) {
    const bool last = attempt + 1 == kAttempts;
    const LossParabola parabola = fit_loss_parabola(data, base, fitted);
    Effects better;
    if (!last && parabola.best_loss < fitted.train.loss - kBetter) better = parabola.best;
    const Uncertainty uncertainty = uncertainty_of(data, fitted);
    std::vector<double> std_dev;
    for (const ValueUncertainty& value : uncertainty.values) {
      if (!better.empty()) break;
      const auto i = static_cast<Index>(std_dev.size());
      if (!(value.std_dev > 0)) {
        std_dev.push_back(0);
        continue;
      }
      const VectorXd direction = value.std_dev * value.line;
      const Profile profile = profile_of(data, fitted, uncertainty.effects, direction, i);
      const Best best = best_of(profile);
      if (!last && best.gain > kBetter)
        better = first_of(moved(uncertainty.effects, best.at * direction), fitted.effects.size());
      const double bend = value.bend * value.std_dev * value.std_dev;
      const double scatter =
          value.by_correlation * value.std_dev * spread(profile, bend, seed + static_cast<std::uint64_t>(i));
      std_dev.push_back(std_dev_of(value, scatter, parabola.std_dev[i]));
    }
    if (better.empty()) {
      fitted.interval_std_dev = std::move(std_dev);
      return fitted;
    }
    Fitted refit = converged(data, fit(data, better, kNothingToBeat, base));
    // A profile along the inaccuracies may decrease the loss where the values alone cannot.
    if (refit.train.loss < fitted.train.loss)
      fitted = std::move(refit);
    else
      attempt = kAttempts - 2;
  }
}

}  // namespace crane::diagnosis
