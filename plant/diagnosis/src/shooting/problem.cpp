#include "shooting/problem.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "noise/learning.hpp"
#include "noise/motion_profile.hpp"
#include "parallel.hpp"
#include "robust.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Time before each window of the swing from which it is simulated: the first row of the window is the report
/// of a sensor whose last 0.3 s are simulated; a longer memory also contains measured motion. Drives need no
/// lead: their filtered command is known from the beginning of the run.
constexpr double kLead_s = 0.3;
/// Number of alternations of start estimation and noise model.
constexpr int kLearningRounds = 3;

/// Natural frequency in a window over that of a small swing at the cable length of the rig file. The
/// stiffness g cos(swing) / l falls with the swing and with the length of the cable in the run.
double frequency_ratio(const PreparedRun& run, const std::vector<double>& swing_rad, const Window& window) {
  constexpr double kLeast = 0.1;
  double mean_cosine = 0, mean_cable_m = 0;
  for (std::size_t k = window.first; k < window.first + window.rows; ++k) {
    mean_cosine += std::cos(swing_rad[k]) / static_cast<double>(window.rows);
    mean_cable_m += run.run.cable_m[k] / static_cast<double>(window.rows);
  }
  const bool known = run.rig_cable_m > 0 && mean_cable_m > 0;
  return std::sqrt(std::max(kLeast, mean_cosine) * (known ? run.rig_cable_m / mean_cable_m : 1));
}

}  // namespace

Problem::Problem(const Runs& runs, Part part, double window_s, double natural_radps)
    : runs_(runs), part_(part) {
  for (const PreparedRun& run : runs)
    if (outputs_.empty()) outputs_ = simulated_outputs(run, part);
  if (outputs_.empty()) return;
  windows_ = windows_of(runs, part, window_s, part == Part::load ? kLead_s : 0, natural_radps);
  for (const Output output : outputs_) {
    std::vector<WindowMotion>& of_output = motions_.emplace_back();
    for (const Window& window : windows_) {
      const PreparedRun& run = runs[window.run];
      const std::vector<double>& position = run.on_grid[output];
      const double radps = part == Part::drive ? 0 : natural_radps * frequency_ratio(run, position, window);
      MotionProfile profile = part == Part::drive ? motion_profile_of(run, output, window.first, window.rows)
                                                  : MotionProfile(window.rows);
      for (std::size_t k = 0; part == Part::load && k < window.rows; ++k)
        profile[k].measured = run.run.is_measured(output, window.first + k);
      of_output.push_back({run.run.period_s, radps, std::move(profile)});
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

void Problem::set_disturbances(std::vector<Disturbance> disturbances) {
  disturbances_ = std::move(disturbances);
  whiteners_.assign(outputs_.size(), {});
  for (std::size_t output = 0; output < outputs_.size(); ++output)
    for (const WindowMotion& motion : motions_[output])
      whiteners_[output].emplace_back(disturbances_[output], motion);
}

Problem Problem::whitened_with(std::vector<Disturbance> disturbances) const {
  Problem whitened = *this;
  if (disturbances.size() == outputs_.size()) {
    whitened.set_disturbances(std::move(disturbances));
  } else {
    whitened.windows_.clear();
    for (std::vector<WindowMotion>& of_output : whitened.motions_) of_output.clear();
  }
  return whitened;
}

Problem Problem::whitened_by(const Replays& crane) const {
  Problem whitened = plain();
  // From the second round on, the starts are estimated with the noise model of the round before.
  for (int round = 0; round < kLearningRounds; ++round)
    whitened.set_disturbances(whitened.disturbances_of(whitened.fit(crane), whitened.disturbances_));
  return whitened;
}

std::vector<Disturbance> Problem::disturbances_of(const Fits& fits,
                                                  const std::vector<Disturbance>& near) const {
  const std::vector<std::vector<VectorXd>> plain = residuals(fits);
  std::vector<Disturbance> learned;
  for (std::size_t output = 0; output < outputs_.size(); ++output)
    learned.push_back(learn(plain[output], motions_[output], least_noise_of(runs_, outputs_[output]),
                            near.empty() ? Disturbance{} : near[output]));
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

std::vector<std::vector<double>> Problem::squares_changed(const Replays& crane, const Fits& at) const {
  std::vector<std::vector<double>> of_windows(windows_.size());
  parallel_for(windows_.size(), [&](std::size_t w) {
    const Window& window = windows_[w];
    const Replay& replay = crane[window.run];
    const VectorXd change = simulate(replay, window, start_near(replay, w, at[w])) - at[w].simulated;
    const auto rows = static_cast<Index>(window.rows);
    for (std::size_t i = 0; i < outputs_.size(); ++i)
      of_windows[w].push_back(change.segment(static_cast<Index>(i) * rows, rows).squaredNorm());
  });
  return of_windows;
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
      if (!runs_[window.run].run.is_measured(outputs_[i], window.first + k))
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

VectorXd Problem::measured_values(const Window& window, std::size_t output) const {
  const Run& run = runs_[window.run].run;
  VectorXd values(static_cast<Index>(measured_rows(window, output)));
  Index next = 0;
  for (std::size_t k = window.first; k < window.first + window.rows; ++k)
    if (run.is_measured(outputs_[output], k)) values[next++] = run.measured[outputs_[output]][k];
  return values;
}

std::size_t Problem::measured_rows(const Window& window, std::size_t output) const {
  const Run& run = runs_[window.run].run;
  std::size_t rows = 0;
  for (std::size_t k = window.first; k < window.first + window.rows; ++k)
    rows += run.is_measured(outputs_[output], k) ? 1 : 0;
  return rows;
}

std::size_t Problem::measured_rows(const Window& window) const {
  std::size_t rows = 0;
  for (std::size_t output = 0; output < outputs_.size(); ++output) rows += measured_rows(window, output);
  return rows;
}

void Problem::whiten(std::size_t window, Eigen::Ref<MatrixXd> x) const {
  const auto rows = static_cast<Index>(windows_[window].rows);
  for (std::size_t i = 0; i < disturbances_.size(); ++i) {
    whiteners_[i][window].apply(x.middleRows(static_cast<Index>(i) * rows, rows));
  }
}

VectorXd Problem::start_near(const Replay& replay, std::size_t w, const WindowFit& at) const {
  VectorXd start = measured_start(replay, windows_[w]);
  const auto known = std::min(at.start.size(), start.size());
  start.head(known) = transferred_start(at, start).head(known);
  return start;
}

std::vector<VectorXd> Problem::plain_change(const Replays& crane, const Fits& at, double step) const {
  std::vector<VectorXd> changes(windows_.size());
  parallel_for(windows_.size(), [&](std::size_t w) {
    const Replay& replay = crane[windows_[w].run];
    changes[w] = (simulate(replay, windows_[w], start_near(replay, w, at[w])) - at[w].simulated) / step;
  });
  return changes;
}

std::vector<std::vector<VectorXd>> Problem::whitened(const std::vector<std::vector<VectorXd>>& plain_slopes,
                                                     const Fits& at) const {
  std::vector<std::vector<VectorXd>> slopes = plain_slopes;
  std::vector<std::vector<VectorXd>*> visible;
  for (std::vector<VectorXd>& slope : slopes)
    if (!slope.empty()) visible.push_back(&slope);
  parallel_for(visible.empty() ? 0 : windows_.size(), [&](std::size_t w) {
    MatrixXd all(at[w].residual.size(), static_cast<Index>(visible.size()));
    for (Index i = 0; i < all.cols(); ++i) all.col(i) = (*visible[static_cast<std::size_t>(i)])[w];
    whiten(w, all);
    all -= at[w].basis * (at[w].basis.transpose() * all).eval();
    for (Index i = 0; i < all.cols(); ++i) (*visible[static_cast<std::size_t>(i)])[w] = all.col(i);
  });
  return slopes;
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
  const VectorXd start = start_near(replay, w, at);
  const auto known = at.start.size(), all = start.size();
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
    const Eigen::ArrayXd information = svd.singularValues().array().square();
    const MatrixXd basis = svd.matrixU() * (1 - 1 / (1 + information).sqrt()).sqrt().matrix().asDiagonal();
    change -= basis * (basis.transpose() * change).eval();
    const VectorXd gradient = svd.matrixU().transpose() * weights_of(at.residual).cwiseProduct(at.residual);
    own_gain =
        (gradient.array().square() * information / (1 + information)).sum() - information.log1p().sum();
  }
  return change;
}

}  // namespace crane::diagnosis
