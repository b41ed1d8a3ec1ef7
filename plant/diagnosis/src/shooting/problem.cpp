#include "shooting/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "noise/learning.hpp"
#include "noise/paces.hpp"
#include "parallel.hpp"
#include "robust.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Before a window of the swing: as long as the longest mean over time of its sensor. Drives need none, the
/// voltage that a lag leaves of their command is known from the beginning of the run.
constexpr double kLead_s = 0.3;
constexpr double kPositionStep = 1e-4, kRateStep = 1e-3;
constexpr int kStartRounds = 8;
/// What the start's directions still explain of a whitened residual, in noise variances: the projection takes
/// it out as well as another round would.
constexpr double kStartFound = 0.1;
/// The same of a plain residual, as a share of it.
constexpr double kPlainStartFound = 1e-4;
constexpr int kLearningRounds = 3;
/// How well a measurement knows a start by itself, generously: positions [m or rad] and rates [per s].
constexpr double kKnownPosition = 0.1, kKnownRate = 1;
/// Largest correction of a start in the first round [m or rad, per s]: the measurement usually knows it
/// better. Of a swing, each round that helps doubles the largest correction of the next one (trust region).
constexpr double kMostPosition = 0.01, kMostRate = 0.1;
/// A swing of whose motion a start leaves more than this share is looked for from other beginnings, too.
constexpr double kPoorlyFollowed = 0.3;
/// Linearisations of one start, at most: the pendulum is nearly linear in its start.
constexpr int kLinearisations = 4;
/// Nothing measures a term's own coordinates: so many times that.
constexpr double kMostInnerStart = 20;

/// @param measured numbers of the start that the measurement knows about
/// @param trust multiple of the largest correction
VectorXd believable(VectorXd change, Index measured, double trust) {
  for (Index i = 0; i < change.size(); ++i) {
    const double freer = trust * (i < measured ? 1 : kMostInnerStart);
    const double most = freer * (i % 2 == 0 ? kMostPosition : kMostRate);
    change[i] = std::isfinite(change[i]) ? std::clamp(change[i], -most, most) : 0.0;
  }
  return change;
}

/// Natural frequency about a large swing against that of a small one: gravity pulls back with g / l
/// cos(swing) per rad.
double softened(const std::vector<double>& swing_rad, const Window& window) {
  constexpr double kLeast = 0.1;
  double mean = 0;
  for (std::size_t k = window.first; k < window.first + window.rows; ++k)
    mean += std::cos(swing_rad[k]) / static_cast<double>(window.rows);
  return std::sqrt(std::max(kLeast, mean));
}

}  // namespace

Problem::Problem(const Runs& runs, Part part, double window_s, double natural_radps)
    : runs_(runs), part_(part) {
  for (const PreparedRun& run : runs)
    if (outputs_.empty()) outputs_ = simulated_outputs(run, part);
  if (outputs_.empty()) return;
  windows_ = windows_of(runs, part, window_s, part == Part::load ? kLead_s : 0, natural_radps);
  for (const Output output : outputs_) {
    std::vector<Passage>& of_output = passages_.emplace_back();
    for (const Window& window : windows_) {
      const PreparedRun& run = runs[window.run];
      const std::vector<double>& position = run.on_grid[output];
      const double radps = part == Part::drive ? 0 : natural_radps * softened(position, window);
      Paces paces = part == Part::drive ? paces_of(position, run.run.period_s, window.first, window.rows)
                                        : Paces(window.rows);
      for (std::size_t k = 0; k < window.rows; ++k) {
        paces[k].seen = run.run.seen(output, window.first + k);
        paces[k].speed_open = part == Part::drive && run.run.may_have_lost_edge(output, window.first + k);
      }
      of_output.push_back({run.run.period_s, radps, std::move(paces)});
    }
  }
}

std::vector<std::vector<VectorXd>> Problem::residuals(const Fits& fits) const {
  std::vector<std::vector<VectorXd>> result(outputs_.size());
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const VectorXd left =
        disturbances_.empty() ? fits[w].residual : measured(windows_[w]) - fits[w].simulated;
    const auto rows = static_cast<Index>(windows_[w].rows);
    for (std::size_t output = 0; output < outputs_.size(); ++output)
      result[output].emplace_back(left.segment(static_cast<Index>(output) * rows, rows));
  }
  return result;
}

void Problem::whiten_with(std::vector<Disturbance> disturbances) {
  // Of an output that nothing was learnt of, for no window of it tells a start, nothing is compared.
  if (disturbances.size() != outputs_.size()) {
    windows_.clear();
    for (std::vector<Passage>& of_output : passages_) of_output.clear();
    return;
  }
  disturbances_ = std::move(disturbances);
  whiteners_.assign(outputs_.size(), {});
  for (std::size_t output = 0; output < outputs_.size(); ++output)
    for (const Passage& passage : passages_[output])
      whiteners_[output].emplace_back(disturbances_[output], passage);
}

void Problem::learn_disturbance(const Replays& crane) {
  disturbances_.clear();
  // After the first time with starts that were solved for with what was learnt before.
  for (int round = 0; round < kLearningRounds; ++round) {
    const std::vector<std::vector<VectorXd>> plain = residuals(fit(crane));
    std::vector<Disturbance> learned;
    for (std::size_t output = 0; output < outputs_.size(); ++output)
      learned.push_back(learn(plain[output], passages_[output], runs_[0].least_noise[outputs_[output]],
                              disturbances_.empty() ? Disturbance{} : disturbances_[output]));
    whiten_with(std::move(learned));
  }
}

std::vector<Disturbance> Problem::disturbances_of(const Fits& fits) const {
  const std::vector<std::vector<VectorXd>> plain = residuals(fits);
  std::vector<Disturbance> learned;
  for (std::size_t output = 0; output < outputs_.size(); ++output)
    learned.push_back(learn(plain[output], passages_[output], runs_[0].least_noise[outputs_[output]]));
  return learned;
}

Problem Problem::plain() const {
  Problem copy = *this;
  copy.disturbances_.clear();
  copy.whiteners_.clear();
  return copy;
}

std::vector<double> Problem::squares_left(const Fits& fits, std::size_t output) const {
  std::vector<double> squares;
  for (std::size_t w = 0; w < fits.size(); ++w) {
    const auto rows = static_cast<Index>(windows_[w].rows);
    const VectorXd residual = measured(windows_[w]) - fits[w].simulated;
    squares.push_back(residual.segment(static_cast<Index>(output) * rows, rows).squaredNorm());
  }
  return squares;
}

VectorXd Problem::simulate(const Replay& replay, const Window& window, const VectorXd& start) const {
  const std::size_t all = window.lead + window.rows;
  std::vector<double> out(all * outputs_.size());
  replay.run(part_, window.first - window.lead, all, {start.data(), static_cast<std::size_t>(start.size())},
             out);
  VectorXd kept(static_cast<Index>(window.rows * outputs_.size()));
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    kept.segment(static_cast<Index>(i * window.rows), static_cast<Index>(window.rows)) =
        Eigen::Map<const VectorXd>(&out[i * all + window.lead], static_cast<Index>(window.rows));
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    for (std::size_t k = 0; k < window.rows; ++k)
      if (!runs_[window.run].run.seen(outputs_[i], window.first + k))
        kept[static_cast<Index>(i * window.rows + k)] = 0;
  return kept;
}

VectorXd Problem::measured(const Window& window) const {
  VectorXd values(static_cast<Index>(window.rows * outputs_.size()));
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    values.segment(static_cast<Index>(i * window.rows), static_cast<Index>(window.rows)) =
        Eigen::Map<const VectorXd>(&runs_[window.run].run.measured[outputs_[i]][window.first],
                                   static_cast<Index>(window.rows));
  return values.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
}

VectorXd Problem::seen(const Window& window, std::size_t output) const {
  const Run& run = runs_[window.run].run;
  VectorXd values(static_cast<Index>(seen_rows(window, output)));
  Index next = 0;
  for (std::size_t k = window.first; k < window.first + window.rows; ++k)
    if (run.seen(outputs_[output], k)) values[next++] = run.measured[outputs_[output]][k];
  return values;
}

std::size_t Problem::seen_rows(const Window& window, std::size_t output) const {
  const Run& run = runs_[window.run].run;
  std::size_t rows = 0;
  for (std::size_t k = window.first; k < window.first + window.rows; ++k)
    rows += run.seen(outputs_[output], k) ? 1 : 0;
  return rows;
}

std::size_t Problem::seen_rows(const Window& window) const {
  std::size_t rows = 0;
  for (std::size_t output = 0; output < outputs_.size(); ++output) rows += seen_rows(window, output);
  return rows;
}

void Problem::whiten(std::size_t window, Eigen::Ref<MatrixXd> x) const {
  const auto rows = static_cast<Index>(windows_[window].rows);
  for (std::size_t i = 0; i < disturbances_.size(); ++i) {
    whiteners_[i][window].apply(x.middleRows(static_cast<Index>(i) * rows, rows));
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

VectorXd Problem::measured_start(const Replay& replay, const Window& window) const {
  const std::vector<double> start = replay.measured_start(part_, window.first - window.lead);
  return Eigen::Map<const VectorXd>(start.data(), static_cast<Index>(start.size()));
}

/// Of a crane that differs little. What rings on by itself would come in quite another phase out of the whole
/// run: it starts where it did.
VectorXd Problem::near_start(const WindowFit& at, const VectorXd& measured) const {
  VectorXd start = at.start;
  start.head(bare_start()) += measured.head(bare_start()) - at.measured_start.head(bare_start());
  return start;
}

void Problem::linearise(const Replay& replay, std::size_t at, WindowFit& fit) const {
  MatrixXd slopes = start_slopes(replay, at, fit.start, fit.simulated, 0);
  // Numbers of the start are known before to these standard deviations: what the measurement says, and of a
  // term's own coordinates where the measured motion of the whole run has brought them.
  const Index measured = bare_start();
  const std::vector<double> inner = replay.inner_start_scale();
  VectorXd scale(slopes.cols());
  for (Index i = 0; i < slopes.cols(); ++i)
    scale[i] = i >= measured ? inner[static_cast<std::size_t>(i - measured)]
               : i % 2 == 0  ? kKnownPosition
                             : kKnownRate;
  fit.inner_slopes = slopes.rightCols(slopes.cols() - measured);
  const Eigen::JacobiSVD<MatrixXd> svd(slopes * scale.asDiagonal(),
                                       Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::ArrayXd told = svd.singularValues().array().square();  // information over what was known
  fit.basis = svd.matrixU() * (1 - 1 / (1 + told).sqrt()).sqrt().matrix().asDiagonal();
  fit.to_start = scale.asDiagonal() * svd.matrixV() * (told.sqrt() / (1 + told)).matrix().asDiagonal() *
                 svd.matrixU().transpose();
  fit.start_price = told.log1p().sum();
}

void Problem::take_start_out(WindowFit& fit) const {
  const Index inner = fit.inner_slopes.cols();
  if (inner > 0) fit.residual += fit.inner_slopes * (fit.start - fit.measured_start).tail(inner);
  fit.residual -= fit.basis * (fit.basis.transpose() * fit.residual).eval();
}

/// Rounds with the directions there are, as long as they help: around standstill they may not.
/// @pre simulated from the start
bool Problem::settle_start(const Replay& replay, std::size_t at, const VectorXd& target,
                           WindowFit& fit) const {
  fit.residual = target - fit.simulated;
  whiten(at, fit.residual);
  bool moved = false;
  double trust = 1;
  for (int round = 1; round < kStartRounds; ++round) {
    const double found = disturbances_.empty() ? kPlainStartFound * fit.residual.squaredNorm() : kStartFound;
    if ((fit.basis.transpose() * fit.residual).squaredNorm() < found) return moved;
    const VectorXd start = fit.start + believable(fit.to_start * fit.residual, bare_start(), trust);
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
  constexpr double kStillGains = 0.99;
  WindowFit fit;
  fit.start = begin;
  double before = std::numeric_limits<double>::infinity();
  const int most = part_ == Part::load ? kLinearisations : 1;
  fit.simulated = simulate(replay, windows_[at], begin);
  linearise(replay, at, fit);
  for (int round = 0; round < most; ++round) {
    const bool moved = settle_start(replay, at, target, fit);
    if (!moved) break;
    linearise(replay, at, fit);
    const double left = fit.residual.squaredNorm();
    if (!(left < kStillGains * before)) break;
    before = left;
  }
  return fit;
}

bool Problem::poorly_followed(std::size_t at, const VectorXd& target, const VectorXd& simulated) const {
  const auto rows = static_cast<Index>(windows_[at].rows);
  for (std::size_t output = 0; output < outputs_.size(); ++output) {
    const VectorXd part = seen(windows_[at], output);
    const double moves = (part.array() - part.mean()).matrix().squaredNorm();
    const auto first = static_cast<Index>(output) * rows;
    const double left = (target - simulated).segment(first, rows).squaredNorm();
    if (!(left <= kPoorlyFollowed * moves)) return true;
  }
  return false;
}

/// The measured start is a derivative of noise, of an averaging sensor, or of what no model explains: where
/// the swing that follows from it does not look like the measured one, the best start is looked for from
/// rest, and from the measured angle without its rate, too. What stands still is one of them: no window is
/// worse than it.
void Problem::fit_start(const Replay& replay, std::size_t at, WindowFit& fit) const {
  const VectorXd target = measured(windows_[at]), begin = measured_start(replay, windows_[at]);
  fit = fit_from(replay, at, target, begin);
  if (part_ == Part::load && poorly_followed(at, target, fit.simulated)) {
    VectorXd without_rate = begin;
    for (Index i = 1; i < bare_start(); i += 2) without_rate[i] = 0;
    const VectorXd at_rest = VectorXd::Zero(begin.size());
    for (const VectorXd& other : {without_rate, at_rest}) {
      WindowFit found = fit_from(replay, at, target, other);
      if (found.residual.squaredNorm() < fit.residual.squaredNorm()) fit = std::move(found);
    }
  }
  fit.measured_start = begin;
  take_start_out(fit);
}

Fits Problem::fit(const Replays& crane) const {
  Fits fits(windows_.size());
  parallel_for(windows_.size(), [&](std::size_t w) { fit_start(crane[windows_[w].run], w, fits[w]); });
  return fits;
}

Fits Problem::fit_again(const Replays& crane, const Fits& near) const {
  Fits fits = near;
  parallel_for(windows_.size(), [&](std::size_t w) {
    const Replay& replay = crane[windows_[w].run];
    if (static_cast<std::size_t>(fits[w].start.size()) != replay.start_size(part_))
      return fit_start(replay, w, fits[w]);
    const VectorXd target = measured(windows_[w]), begin = fits[w].start;
    fits[w] = fit_from(replay, w, target, begin);
    fits[w].measured_start = measured_start(replay, windows_[w]);
    take_start_out(fits[w]);
  });
  return fits;
}

Fits Problem::fit_near(const Replays& crane, const Fits& near) const {
  Fits fits = near;
  parallel_for(windows_.size(), [&](std::size_t w) {
    const Window& window = windows_[w];
    WindowFit& fit = fits[w];
    const Replay& replay = crane[window.run];
    if (static_cast<std::size_t>(fit.start.size()) != replay.start_size(part_))
      return fit_start(replay, w, fit);
    const VectorXd target = measured(window), moved = measured_start(replay, window);
    fit.start = near_start(fit, moved);
    fit.measured_start = moved;
    fit.simulated = simulate(replay, window, fit.start);
    settle_start(replay, w, target, fit);
    take_start_out(fit);
  });
  return fits;
}

std::vector<VectorXd> Problem::change(const Replays& crane, const Fits& at, double step, double* own) const {
  std::vector<VectorXd> changes(windows_.size());
  std::vector<double> gains(windows_.size());
  parallel_for(windows_.size(), [&](std::size_t w) {
    changes[w] = change_in(crane[windows_[w].run], w, at[w], step, gains[w]);
  });
  if (own != nullptr) *own = std::accumulate(gains.begin(), gains.end(), 0.0);
  return changes;
}

VectorXd Problem::change_in(const Replay& replay, std::size_t w, const WindowFit& at, double step,
                            double& own_gain) const {
  const auto outside = [&](const MatrixXd& x) -> MatrixXd {
    return x - at.basis * (at.basis.transpose() * x).eval();
  };
  VectorXd start = measured_start(replay, windows_[w]);
  const auto known = at.start.size(), all = start.size();
  start.head(known) = near_start(at, start.head(known));
  const VectorXd simulated = simulate(replay, windows_[w], start);
  MatrixXd change = (simulated - at.simulated) / step;
  whiten(w, change);
  change = outside(change);
  if (all > known) {
    const std::vector<double> inner = replay.inner_start_scale();
    const auto fresh = all - known;
    const VectorXd scale =
        Eigen::Map<const VectorXd>(inner.data(), static_cast<Index>(inner.size())).tail(fresh);
    const MatrixXd slopes = outside(start_slopes(replay, w, start, simulated, known)) * scale.asDiagonal();
    const Eigen::JacobiSVD<MatrixXd> svd(slopes, Eigen::ComputeThinU);
    const Eigen::ArrayXd told = svd.singularValues().array().square();
    const MatrixXd basis = svd.matrixU() * (1 - 1 / (1 + told).sqrt()).sqrt().matrix().asDiagonal();
    change -= basis * (basis.transpose() * change).eval();
    const VectorXd pull = svd.matrixU().transpose() * weights_of(at.residual).cwiseProduct(at.residual);
    own_gain = (pull.array().square() * told / (1 + told)).sum() - told.log1p().sum();
  }
  return change;
}

}  // namespace crane::diagnosis
