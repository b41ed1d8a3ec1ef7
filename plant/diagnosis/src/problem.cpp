#include "problem.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// As long as the longest mean over time of a swing sensor.
constexpr double kLead_s = 0.3;
/// Longer windows are cut: whitening takes a matrix of rows times rows.
constexpr std::size_t kMostRows = 1000;
constexpr double kPositionStep = 1e-4, kRateStep = 1e-3;
constexpr int kStartRounds = 8;
/// What the start's directions still explain of a whitened residual, in noise variances: the projection takes
/// it out as well as another round would.
constexpr double kStartFound = 0.1;
/// The same of a plain residual, as a share of it.
constexpr double kPlainStartFound = 1e-4;
/// Mean square of a whitened window, in those of the median window, beyond which it counts less.
constexpr double kNoisiest = 2.0;
/// A start direction that changes the window less than this share of the strongest one cannot be solved for:
/// the speed of an axis that sticks is forgotten at once.
constexpr double kLeastSlope = 0.001;
/// The measurement knows the start better than this; a larger correction in one round is not believed.
constexpr double kMostPosition = 0.01, kMostRate = 0.1;
/// Nothing measures a term's own coordinates: so many times that.
constexpr double kMostInnerStart = 20;

/// @param measured numbers of the start that the measurement knows about
VectorXd believable(VectorXd change, Index measured) {
  for (Index i = 0; i < change.size(); ++i) {
    const double freer = i < measured ? 1 : kMostInnerStart;
    const double most = freer * (i % 2 == 0 ? kMostPosition : kMostRate);
    change[i] = std::isfinite(change[i]) ? std::clamp(change[i], -most, most) : 0.0;
  }
  return change;
}

}  // namespace

Problem::Problem(const Runs& runs, Part part, double window_s) : runs_(runs), part_(part) {
  for (const PreparedRun& run : runs)
    if (outputs_.empty()) outputs_ = simulated_outputs(run, part);
  if (outputs_.empty()) return;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const double period_s = runs[i].run.period_s;
    const auto lead = static_cast<std::size_t>(std::lround(kLead_s / period_s));
    const std::size_t rows = runs[i].run.rows();
    const auto wanted = std::min(static_cast<std::size_t>(window_s / period_s), kMostRows);
    if (rows < lead + wanted / 2) continue;
    const std::size_t count = std::max<std::size_t>(1, (rows - lead + wanted / 2) / wanted);
    const std::size_t length = std::min((rows - lead) / count, kMostRows);
    for (std::size_t w = 0; w < count; ++w) windows_.push_back({i, lead + w * length, length, lead});
  }
}

std::vector<std::vector<VectorXd>> Problem::residuals(const Crane& crane) const {
  const Fits fits = fit(crane);
  std::vector<std::vector<VectorXd>> result(outputs_.size());
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const VectorXd left = whiteners_.empty() ? fits[w].residual : measured(windows_[w]) - fits[w].simulated;
    const auto rows = static_cast<Index>(windows_[w].rows);
    for (std::size_t output = 0; output < outputs_.size(); ++output)
      result[output].emplace_back(left.segment(static_cast<Index>(output) * rows, rows));
  }
  return result;
}

void Problem::weigh(const std::vector<std::vector<VectorXd>>& residuals) {
  weights_.assign(outputs_.size(), std::vector<double>(windows_.size(), 1.0));
  for (std::size_t output = 0; output < outputs_.size(); ++output) {
    std::vector<double> squares;
    for (const VectorXd& residual : residuals[output]) {
      VectorXd white = residual;
      whiteners_[output].apply(white);
      squares.push_back(white.squaredNorm() / static_cast<double>(white.size()));
    }
    std::vector<double> sorted = squares;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                     sorted.end());
    const double most = kNoisiest * sorted[sorted.size() / 2];
    for (std::size_t w = 0; w < squares.size(); ++w)
      if (most > 0 && squares[w] > most) weights_[output][w] = std::sqrt(most / squares[w]);
  }
}

void Problem::learn_disturbance(const Crane& crane, double natural_radps) {
  whiteners_.clear();
  // The second time with starts that were solved for with what was learnt the first time.
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<std::vector<VectorXd>> plain = residuals(crane);
    for (int round = 0; round < 3; ++round) {
      std::vector<Whitener> learned;
      for (std::size_t output = 0; output < outputs_.size(); ++output) {
        std::vector<VectorXd> weighted = plain[output];
        if (round > 0)
          for (std::size_t w = 0; w < weighted.size(); ++w) weighted[w] *= weights_[output][w];
        const bool swing = outputs_[output] == kRadialSwing || outputs_[output] == kTangentialSwing;
        learned.emplace_back(weighted, runs_[windows_[0].run].run.period_s, swing ? natural_radps : 0);
      }
      whiteners_ = std::move(learned);
      weigh(plain);
    }
  }
}

void Problem::whiten_like(const Problem& other, const Crane& crane) {
  whiteners_ = other.whiteners_;
  for (Whitener& whitener : whiteners_)
    for (const Window& window : windows_) whitener.prepare(static_cast<Index>(window.rows));
  weights_.assign(outputs_.size(), std::vector<double>(windows_.size(), 1.0));
  weigh(residuals(crane));
}

std::vector<Replay> Problem::replays(const Runs& runs, const Crane& crane) const {
  std::vector<std::optional<Replay>> made(runs.size());
  parallel_for(runs.size(), [&](std::size_t i) { made[i].emplace(runs[i], crane, part_); });
  std::vector<Replay> result;
  for (auto& replay : made) result.push_back(std::move(*replay));
  return result;
}

VectorXd Problem::simulate(const Replay& replay, const Window& window, const VectorXd& start) const {
  const std::size_t all = window.lead + window.rows;
  std::vector<double> out(all * outputs_.size());
  replay.run(window.first - window.lead, all, {start.data(), static_cast<std::size_t>(start.size())}, out);
  VectorXd kept(static_cast<Index>(window.rows * outputs_.size()));
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    kept.segment(static_cast<Index>(i * window.rows), static_cast<Index>(window.rows)) =
        Eigen::Map<const VectorXd>(&out[i * all + window.lead], static_cast<Index>(window.rows));
  return kept;
}

VectorXd Problem::measured(const Window& window) const {
  VectorXd values(static_cast<Index>(window.rows * outputs_.size()));
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    values.segment(static_cast<Index>(i * window.rows), static_cast<Index>(window.rows)) =
        Eigen::Map<const VectorXd>(&runs_[window.run].run.measured[outputs_[i]][window.first],
                                   static_cast<Index>(window.rows));
  return values;
}

void Problem::whiten(std::size_t window, Eigen::Ref<MatrixXd> x) const {
  const auto rows = static_cast<Index>(windows_[window].rows);
  for (std::size_t i = 0; i < whiteners_.size(); ++i) {
    whiteners_[i].apply(x.middleRows(static_cast<Index>(i) * rows, rows));
    x.middleRows(static_cast<Index>(i) * rows, rows) *= weights_[i][window];
  }
}

MatrixXd Problem::start_slopes(const Replay& replay, std::size_t at, const VectorXd& start,
                               const VectorXd& simulated, Index first) const {
  MatrixXd slopes(simulated.size(), start.size() - first);
  for (Index i = first; i < start.size(); ++i) {
    const double step = i % 2 == 0 ? kPositionStep : kRateStep;
    VectorXd moved = start;
    moved[i] += step;
    slopes.col(i - first) = (simulate(replay, windows_[at], moved) - simulated) / step;
  }
  whiten(at, slopes);
  return slopes;
}

VectorXd Problem::measured_start(const Replay& replay, const Window& window) {
  const std::vector<double> start = replay.measured_start(window.first - window.lead);
  return Eigen::Map<const VectorXd>(start.data(), static_cast<Index>(start.size()));
}

void Problem::linearise(const Replay& replay, std::size_t at, WindowFit& fit) const {
  fit.simulated = simulate(replay, windows_[at], fit.start);
  MatrixXd slopes = start_slopes(replay, at, fit.start, fit.simulated, 0);
  // By what a believable change of each does. A coordinate of a term's own is in a length of its own: what it
  // changes counts against the rest in shape.
  const Index measured = bare_start();
  VectorXd scale(slopes.cols());
  for (Index i = 0; i < measured; ++i) scale[i] = i % 2 == 0 ? kMostPosition : kMostRate;
  const double strongest =
      (slopes.leftCols(measured) * scale.head(measured).asDiagonal()).colwise().norm().maxCoeff();
  for (Index i = measured; i < slopes.cols(); ++i) {
    const double norm = slopes.col(i).norm();
    scale[i] = norm > 0 ? strongest / norm : 1;
  }
  slopes = slopes * scale.asDiagonal();
  Eigen::ColPivHouseholderQR<MatrixXd> qr(slopes.rows(), slopes.cols());
  qr.setThreshold(kLeastSlope);
  qr.compute(slopes);
  fit.basis = qr.householderQ() * MatrixXd::Identity(slopes.rows(), qr.rank());
  fit.to_start = scale.asDiagonal() * qr.solve(MatrixXd(fit.basis)) * fit.basis.transpose();
  fit.freedom = static_cast<double>(slopes.cols() - measured);
}

/// Rounds with the directions there are, as long as they help: around standstill they may not.
/// @pre simulated from the start
void Problem::settle_start(const Replay& replay, std::size_t at, const VectorXd& target,
                           WindowFit& fit) const {
  fit.residual = target - fit.simulated;
  whiten(at, fit.residual);
  for (int round = 1; round < kStartRounds; ++round) {
    const double found = whiteners_.empty() ? kPlainStartFound * fit.residual.squaredNorm() : kStartFound;
    if ((fit.basis.transpose() * fit.residual).squaredNorm() < found) return;
    const VectorXd start = fit.start + believable(fit.to_start * fit.residual, bare_start());
    VectorXd simulated = simulate(replay, windows_[at], start), residual = target - simulated;
    whiten(at, residual);
    if (residual.squaredNorm() >= fit.residual.squaredNorm()) return;
    fit.start = start;
    fit.simulated = std::move(simulated);
    fit.residual = std::move(residual);
  }
}

void Problem::fit_start(const Replay& replay, std::size_t at, WindowFit& fit) const {
  const Window& window = windows_[at];
  fit.start = fit.measured_start = measured_start(replay, window);
  const VectorXd target = measured(window);
  linearise(replay, at, fit);
  settle_start(replay, at, target, fit);
  linearise(replay, at, fit);
  fit.residual = target - fit.simulated;
  whiten(at, fit.residual);
  fit.residual -= fit.basis * (fit.basis.transpose() * fit.residual).eval();
}

Fits Problem::fit(const Crane& crane) const {
  const std::vector<Replay> replay = replays(runs_, crane);
  Fits fits(windows_.size());
  parallel_for(windows_.size(), [&](std::size_t w) { fit_start(replay[windows_[w].run], w, fits[w]); });
  return fits;
}

Fits Problem::fit_near(const Crane& crane, const Fits& near) const {
  const std::vector<Replay> replay = replays(runs_, crane);
  Fits fits = near;
  parallel_for(windows_.size(), [&](std::size_t w) {
    const Window& window = windows_[w];
    WindowFit& fit = fits[w];
    if (static_cast<std::size_t>(fit.start.size()) != replay[window.run].start_size())
      return fit_start(replay[window.run], w, fit);
    const VectorXd target = measured(window), moved = measured_start(replay[window.run], window);
    fit.start += moved - fit.measured_start;
    fit.measured_start = moved;
    fit.simulated = simulate(replay[window.run], window, fit.start);
    settle_start(replay[window.run], w, target, fit);
    fit.residual -= fit.basis * (fit.basis.transpose() * fit.residual).eval();
  });
  return fits;
}

std::vector<VectorXd> Problem::change(const Crane& crane, const Fits& at, double step, double* own) const {
  return change_on(runs_, crane, at, step, own);
}

std::vector<VectorXd> Problem::change_on(const Runs& runs, const Crane& crane, const Fits& at, double step,
                                         double* own) const {
  const std::vector<Replay> replay = replays(runs, crane);
  std::vector<VectorXd> changes(windows_.size());
  std::vector<double> gains(windows_.size());
  parallel_for(windows_.size(), [&](std::size_t w) {
    changes[w] = change_in(replay[windows_[w].run], w, at[w], step, gains[w]);
  });
  if (own != nullptr) *own = std::accumulate(gains.begin(), gains.end(), 0.0);
  return changes;
}

VectorXd Problem::change_in(const Replay& replay, std::size_t w, const WindowFit& at, double step,
                            double& own_gain) const {
  const auto outside = [&](MatrixXd x) -> MatrixXd {
    return x - at.basis * (at.basis.transpose() * x).eval();
  };
  VectorXd start = measured_start(replay, windows_[w]);
  const auto known = at.start.size(), all = start.size();
  start.head(known) += at.start - at.measured_start;
  const VectorXd simulated = simulate(replay, windows_[w], start);
  MatrixXd change = (simulated - at.simulated) / step;
  whiten(w, change);
  change = outside(change);
  if (all > known) {
    MatrixXd slopes = outside(start_slopes(replay, w, start, simulated, known));
    slopes.colwise().normalize();
    Eigen::ColPivHouseholderQR<MatrixXd> qr(slopes.rows(), slopes.cols());
    qr.setThreshold(kLeastSlope);
    qr.compute(slopes);
    const MatrixXd basis = qr.householderQ() * MatrixXd::Identity(slopes.rows(), qr.rank());
    change -= basis * (basis.transpose() * change).eval();
    own_gain =
        (basis.transpose() * at.residual).squaredNorm() - kStartPrice * static_cast<double>(all - known);
  }
  return change;
}

}  // namespace crane::diagnosis
