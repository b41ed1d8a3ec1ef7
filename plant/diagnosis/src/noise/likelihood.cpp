#include "noise/likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "noise/filter.hpp"
#include "parallel.hpp"
#include "robust.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Variance of an unknown start, in noise variances.
constexpr double kUnknownStartVariance = 1e8;

/// Sum of logarithms of numbers >= 1. Products of the numbers save calls of log().
class SumOfLogs {
 public:
  void add(double number) {
    product_ *= number;
    if (product_ > kLarge) sum_ += std::log(product_), product_ = 1;
  }
  [[nodiscard]] double value() const { return sum_ + std::log(product_); }

 private:
  static constexpr double kLarge = 1e100;
  double sum_ = 0, product_ = 1;
};

/// Squares of the innovations divided by their variances, for the measured rows.
struct Innovations {
  std::vector<double> squares;
  double logs = 0;  ///< sum of ln variance
};

Innovations innovations(const VectorXd& residual, const WindowMotion& motion, const Disturbance& d) {
  constexpr std::size_t kStart = 2;
  Innovations all;
  all.squares.reserve(static_cast<std::size_t>(residual.size()));
  PredictionCovariance prediction(d, motion, kUnknownStartVariance);
  SumOfLogs logs;
  const Matrix3d step = transition_of(d, motion);
  Vector3d state = Vector3d::Zero();
  std::size_t measured = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(residual.size()); ++k) {
    if (motion.profile[k].measured) {
      const double innovation = residual[static_cast<Index>(k)] - state[0], f = prediction.variance();
      if (measured++ >= kStart) {
        logs.add(f);
        all.squares.push_back(innovation * innovation / f);
      }
      state += prediction.gain() * innovation;
    }
    state = next_state(step, state, prediction.phase(k));
    prediction.advance(k);
  }
  all.logs = logs.value();
  return all;
}

/// Variance at which the mean loss is that of normal residuals: Newton's method in its logarithm.
/// @param near guess, > 0
double robust_variance(const std::vector<Innovations>& of_windows, double near) {
  constexpr int kRounds = 40;
  constexpr double kExact = 1e-5, kLongestStep = 3;
  double variance = near;
  for (int round = 0; round < kRounds; ++round) {
    SumOfLogs logs;
    double slope = 0, count = 0;
    for (const Innovations& window : of_windows) {
      for (const double square : window.squares) {
        const double z = square / (kCauchyScaleSquared * variance);
        logs.add(1 + z);
        slope += z / (1 + z);
      }
      count += static_cast<double>(window.squares.size());
    }
    const double step = (logs.value() - kMeanLoss / kCauchyScaleSquared * count) / slope;
    variance *= std::exp(std::clamp(step, -kLongestStep, kLongestStep));
    if (!(std::abs(step) > kExact)) break;
  }
  return variance;
}

/// Whether the robust variance is at least `variance`. The mean loss decreases with the variance: one
/// evaluation of the loss decides.
bool robust_variance_is_at_least(double variance, const std::vector<Innovations>& of_windows, double count) {
  const double least = kMeanLoss / kCauchyScaleSquared * count;
  const double scale = 1 / (kCauchyScaleSquared * variance);
  SumOfLogs logs;
  for (const Innovations& window : of_windows) {
    for (const double square : window.squares) logs.add(1 + scale * square);
    if (logs.value() >= least) return true;
  }
  return false;
}

struct AllInnovations {
  std::vector<Innovations> of_windows;
  double logs = 0, squares = 0, count = 0;
};

AllInnovations all_innovations(const std::vector<VectorXd>& residuals,
                               const std::vector<WindowMotion>& motions, const Disturbance& d) {
  AllInnovations all;
  all.of_windows.resize(residuals.size());
  parallel_for(residuals.size(),
               [&](std::size_t w) { all.of_windows[w] = innovations(residuals[w], motions[w], d); });
  for (const Innovations& window : all.of_windows) {
    all.logs += window.logs;
    for (const double square : window.squares) all.squares += square;
    all.count += static_cast<double>(window.squares.size());
  }
  return all;
}

double value_at(double variance, const AllInnovations& all) {
  SumOfLogs logs;
  for (const Innovations& window : all.of_windows)
    for (const double square : window.squares) logs.add(1 + square / (kCauchyScaleSquared * variance));
  const double excess = kCauchyScaleSquared * logs.value() - kMeanLoss * all.count;
  return all.logs + all.count * std::log(variance) + excess / kLossPerDeviance;
}

}  // namespace

Likelihood likelihood(const std::vector<VectorXd>& residuals, const std::vector<WindowMotion>& motions,
                      const Disturbance& d, const Likelihood& best) {
  const AllInnovations all = all_innovations(residuals, motions, d);
  if (!(all.squares > 0)) return {};
  if (best.variance > 0 &&
      robust_variance_is_at_least(std::exp((best.value - all.logs) / all.count), all.of_windows, all.count))
    return {};
  const double variance =
      robust_variance(all.of_windows, best.variance > 0 ? best.variance : all.squares / all.count);
  return {all.logs + all.count * std::log(variance), variance};
}

double value_at(double variance, const std::vector<VectorXd>& residuals,
                const std::vector<WindowMotion>& motions, const Disturbance& d) {
  return value_at(variance, all_innovations(residuals, motions, d));
}

}  // namespace crane::diagnosis
