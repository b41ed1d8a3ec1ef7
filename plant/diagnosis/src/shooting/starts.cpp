/// Starts of windows: Gauss-Newton in a trust region, from several initial values if the fit from the first
/// one is poor.
#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel.hpp"
#include "shooting/problem.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Finite differences: position [m or rad], rate [m/s or rad/s].
constexpr double kStartPositionStep = 1e-4, kStartRateStep = 1e-3;
/// Largest number of steps with one linearisation.
constexpr int kMostStartSteps = 7;
/// The same for residuals that are not whitened. A residual in m or rad then counts as one of variance 1: the
/// prior dominates, and the steps are short.
constexpr int kMostPlainStartSteps = 99;
/// A start has converged when it explains less of the residual: in noise variances; as a share of the sum of
/// squares of a residual that is not whitened. The projection removes the explained part.
constexpr double kStartConverged = 0.1, kPlainStartConverged = 1e-4;
/// Prior standard deviations of a start: position [m or rad], rate [m/s or rad/s].
constexpr double kPriorPosition = 0.1, kPriorRate = 1;
/// Initial trust region: position [m or rad], rate [m/s or rad/s].
constexpr double kLargestPositionCorrection = 0.01, kLargestRateCorrection = 0.1;
/// Trust region of inner coordinates, which no sensor measures, in multiples of the above.
constexpr double kInnerCorrectionRatio = 20;
/// Share of the sum of squares of a motion. If the fit leaves more, it is repeated from other initial values.
constexpr double kPoorlyFollowed = 0.3;
/// Largest number of linearisations of a swing, which is nearly linear in its start, and of a plain residual.
constexpr int kMostLinearisations = 4;

/// @param outputs number of elements that belong to outputs; inner coordinates follow
/// @param trust multiple of the initial trust region
VectorXd clamped_correction(VectorXd change, Index outputs, double trust) {
  for (Index i = 0; i < change.size(); ++i) {
    const double radius = trust * (i < outputs ? 1 : kInnerCorrectionRatio);
    const double most = radius * (i % 2 == 0 ? kLargestPositionCorrection : kLargestRateCorrection);
    change[i] = std::isfinite(change[i]) ? std::clamp(change[i], -most, most) : 0.0;
  }
  return change;
}

}  // namespace

MatrixXd Problem::start_slopes(const Replay& replay, std::size_t at, const VectorXd& start,
                               const VectorXd& simulated, Index first) const {
  MatrixXd slopes(simulated.size(), start.size() - first);
  for (Index i = first; i < start.size(); ++i) {
    const double step = i % 2 == 0 ? kStartPositionStep : kStartRateStep;
    VectorXd moved = start;
    moved[i] += step;
    slopes.col(i - first) = (simulate(replay, windows_[at], moved) - simulated) / step;
  }
  whiten(at, slopes);
  return slopes;
}

VectorXd Problem::measured_start(const Replay& replay, const Window& window) const {
  const std::vector<double> start = replay.measured_start(part_, window.first - window.lead);
  return Eigen::Map<const VectorXd>(start.data(), static_cast<Index>(start.size()));
}

/// The start of the outputs changes by the change of their measured start. Ringing inner coordinates keep
/// their start, because their phase after a whole run is not reproducible.
VectorXd Problem::transferred_start(const WindowFit& at, const VectorXd& measured) const {
  VectorXd start = at.start;
  start.head(output_start_size()) +=
      measured.head(output_start_size()) - at.measured_start.head(output_start_size());
  return start;
}

void Problem::linearise(const Replay& replay, std::size_t at, WindowFit& fit) const {
  MatrixXd slopes = start_slopes(replay, at, fit.start, fit.simulated, 0);
  // Prior standard deviations S; for inner coordinates, their rms along the measured motion.
  const Index measured = output_start_size();
  const std::vector<double> inner = replay.inner_start_scale();
  VectorXd scale(slopes.cols());
  for (Index i = 0; i < slopes.cols(); ++i)
    scale[i] = i >= measured ? inner[static_cast<std::size_t>(i - measured)]
               : i % 2 == 0  ? kPriorPosition
                             : kPriorRate;
  fit.inner_slopes = slopes.rightCols(slopes.cols() - measured);
  const Eigen::JacobiSVD<MatrixXd> svd(slopes * scale.asDiagonal(),
                                       Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::ArrayXd information = svd.singularValues().array().square();  // relative to the prior
  fit.basis = svd.matrixU() * (1 - 1 / (1 + information).sqrt()).sqrt().matrix().asDiagonal();
  fit.start_gain = scale.asDiagonal() * svd.matrixV() *
                   (information.sqrt() / (1 + information)).matrix().asDiagonal() * svd.matrixU().transpose();
  fit.start_log_determinant = information.log1p().sum();
}

void Problem::marginalise_start(WindowFit& fit) const {
  const Index inner = fit.inner_slopes.cols();
  if (inner > 0) fit.residual += fit.inner_slopes * (fit.start - fit.measured_start).tail(inner);
  fit.residual -= fit.basis * (fit.basis.transpose() * fit.residual).eval();
}

/// Gauss-Newton steps with a fixed linearisation while the residual decreases. @pre `fit.simulated` is
/// simulated from `fit.start`
bool Problem::refine_start(const Replay& replay, std::size_t at, const VectorXd& target,
                           WindowFit& fit) const {
  fit.residual = target - fit.simulated;
  whiten(at, fit.residual);
  bool moved = false;
  double trust = 1;
  const int most = disturbances_.empty() ? kMostPlainStartSteps : kMostStartSteps;
  for (int step = 0; step < most; ++step) {
    const double found =
        disturbances_.empty() ? kPlainStartConverged * fit.residual.squaredNorm() : kStartConverged;
    if ((fit.basis.transpose() * fit.residual).squaredNorm() < found) return moved;
    const VectorXd start =
        fit.start + clamped_correction(fit.start_gain * fit.residual, output_start_size(), trust);
    VectorXd simulated = simulate(replay, windows_[at], start);
    VectorXd residual = target - simulated;
    whiten(at, residual);
    if (!(residual.squaredNorm() < fit.residual.squaredNorm())) {
      if (trust <= 1) return moved;
      trust /= 4;
      continue;
    }
    if (part_ == Part::load) trust *= 2;
    moved = true;
    fit.start = start;
    fit.simulated = std::move(simulated);
    fit.residual = std::move(residual);
  }
  return moved;
}

WindowFit Problem::fit_from(const Replay& replay, std::size_t at, const VectorXd& target,
                            const VectorXd& begin) const {
  constexpr double kLargestDecreaseRatio = 0.99;
  WindowFit fit;
  fit.start = begin;
  double before = std::numeric_limits<double>::infinity();
  const int most = part_ == Part::load || disturbances_.empty() ? kMostLinearisations : 1;
  fit.simulated = simulate(replay, windows_[at], begin);
  linearise(replay, at, fit);
  for (int round = 0; round < most; ++round) {
    const bool moved = refine_start(replay, at, target, fit);
    if (!moved) break;
    linearise(replay, at, fit);
    const double left = fit.residual.squaredNorm();
    if (!(left < kLargestDecreaseRatio * before)) break;
    before = left;
  }
  return fit;
}

bool Problem::poorly_followed(std::size_t at, const VectorXd& target, const VectorXd& simulated) const {
  const auto rows = static_cast<Index>(windows_[at].rows);
  for (std::size_t output = 0; output < outputs_.size(); ++output) {
    const VectorXd part = measured_values(windows_[at], output);
    const double moves = (part.array() - part.mean()).matrix().squaredNorm();
    const auto first = static_cast<Index>(output) * rows;
    const double left = (target - simulated).segment(first, rows).squaredNorm();
    if (!(left <= kPoorlyFollowed * moves)) return true;
  }
  return false;
}

/// The measured rate may be wrong: noise, an averaging sensor, a motion that the model lacks. If the fit of a
/// swing is poor, the start is also estimated from the measured angle with rate zero and from a load at rest.
/// The residual is therefore never larger than that of a load at rest. The plain residual of a drive is also
/// fitted from the measured position with rate zero.
void Problem::fit_start(const Replay& replay, std::size_t at, WindowFit& fit) const {
  const VectorXd target = measured(windows_[at]), begin = measured_start(replay, windows_[at]);
  fit = fit_from(replay, at, target, begin);
  const bool load = part_ == Part::load;
  if ((load || disturbances_.empty()) && poorly_followed(at, target, fit.simulated)) {
    VectorXd without_rate = begin;
    for (Index i = 1; i < output_start_size(); i += 2) without_rate[i] = 0;
    std::vector<VectorXd> others{without_rate};
    if (load) others.push_back(VectorXd::Zero(begin.size()));
    for (const VectorXd& other : others) {
      WindowFit found = fit_from(replay, at, target, other);
      if (found.residual.squaredNorm() < fit.residual.squaredNorm()) fit = std::move(found);
    }
  }
  fit.measured_start = begin;
  marginalise_start(fit);
}

WindowFit Problem::continued_from(const Replay& replay, std::size_t at, const Fits& fits) const {
  const Window &before = windows_[at - 1], &window = windows_[at];
  const std::size_t from = before.first - before.lead, rows = window.first - window.lead - from + 1;
  const VectorXd& start = fits[at - 1].start;
  std::vector<double> outputs(rows * outputs_.size()), end;
  replay.run(part_, from, rows, {start.data(), static_cast<std::size_t>(start.size())}, outputs, &end);
  WindowFit found = fit_from(replay, at, measured(window),
                             Eigen::Map<const VectorXd>(end.data(), static_cast<Index>(end.size())));
  found.measured_start = fits[at].measured_start;
  marginalise_start(found);
  return found;
}

/// No sensor measures the coordinates that ring freely: a fit from the measured start can end in another
/// minimum. The motion continues from window to window. Each window is therefore also fitted from the end of
/// the window before, again while this improves the window before.
void Problem::continue_ringing(const Replays& crane, Fits& fits) const {
  const auto misfit = [](const WindowFit& fit) {
    return fit.residual.squaredNorm() + fit.start_log_determinant;
  };
  std::vector<std::size_t> next;
  for (std::size_t w = 1; w < windows_.size(); ++w)
    if (windows_[w - 1].run == windows_[w].run &&
        windows_[w - 1].first + windows_[w - 1].rows == windows_[w].first)
      next.push_back(w);
  const std::vector<std::size_t> continued = next;
  while (!next.empty()) {
    std::vector<WindowFit> found(next.size());
    parallel_for(next.size(), [&](std::size_t i) {
      found[i] = continued_from(crane[windows_[next[i]].run], next[i], fits);
    });
    std::vector<std::size_t> after;
    for (std::size_t i = 0; i < next.size(); ++i) {
      const double now = misfit(fits[next[i]]);
      const double least = disturbances_.empty() ? kPlainStartConverged * now : kStartConverged;
      if (!(misfit(found[i]) < now - least)) continue;
      fits[next[i]] = std::move(found[i]);
      if (std::ranges::binary_search(continued, next[i] + 1)) after.push_back(next[i] + 1);
    }
    next = std::move(after);
  }
}

Fits Problem::fit(const Replays& crane) const {
  Fits fits(windows_.size());
  parallel_for(windows_.size(), [&](std::size_t w) { fit_start(crane[windows_[w].run], w, fits[w]); });
  if (part_ == Part::load && !fits.empty() && fits[0].start.size() > output_start_size())
    continue_ringing(crane, fits);
  return fits;
}

bool Problem::has_other_coordinates(const Replays& crane, const Fits& fits) const {
  return !fits.empty() &&
         static_cast<std::size_t>(fits[0].start.size()) != crane[windows_[0].run].start_size(part_);
}

Fits Problem::fit_again(const Replays& crane, const Fits& near) const {
  if (has_other_coordinates(crane, near)) return fit(crane);
  Fits fits = near;
  parallel_for(windows_.size(), [&](std::size_t w) {
    const Replay& replay = crane[windows_[w].run];
    const VectorXd target = measured(windows_[w]), begin = fits[w].start;
    fits[w] = fit_from(replay, w, target, begin);
    fits[w].measured_start = measured_start(replay, windows_[w]);
    marginalise_start(fits[w]);
  });
  return fits;
}

Fits Problem::fit_near(const Replays& crane, const Fits& near) const {
  if (has_other_coordinates(crane, near)) return fit(crane);
  Fits fits = near;
  parallel_for(windows_.size(), [&](std::size_t w) {
    const Window& window = windows_[w];
    WindowFit& fit = fits[w];
    const Replay& replay = crane[window.run];
    const VectorXd target = measured(window), moved = measured_start(replay, window);
    fit.start = transferred_start(fit, moved);
    fit.measured_start = moved;
    fit.simulated = simulate(replay, window, fit.start);
    refine_start(replay, w, target, fit);
    marginalise_start(fit);
  });
  return fits;
}

}  // namespace crane::diagnosis
