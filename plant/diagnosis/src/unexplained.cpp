#include "unexplained.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "parallel.hpp"
#include "robust.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kProbe_v = 0.05;
constexpr double kLeastSpeed = 0.01;  // m/s or rad/s: an extra voltage on an axis that sticks does nothing
constexpr std::size_t kFolds = 4;
/// A force that builds up after a reversal has done so within this share of the travel.
constexpr double kBuildUp = 0.25;

/// A force pattern: a voltage by row for every run.
struct Pattern {
  std::vector<std::vector<double>> voltage;
};

struct Variable {
  std::string name;
  plant::Axis axis;
  std::vector<Pattern> bins;
};

/// Triangular bins over [low, high] of `value(run, row)`, only while the axis moves.
template <class Value>
Variable binned(const std::string& name, plant::Axis axis, const Runs& runs, std::size_t bins, double low,
                double high, Value&& value) {
  Variable variable{name, axis, std::vector<Pattern>(bins)};
  for (Pattern& pattern : variable.bins)
    for (const PreparedRun& run : runs) pattern.voltage.emplace_back(run.run.rows(), 0.0);
  if (!(high > low)) return variable;
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (std::size_t k = 0; k < runs[r].run.rows(); ++k) {
      if (std::abs(runs[r].motion[axis].rate[k]) < kLeastSpeed) continue;
      const double at =
          std::clamp((value(r, k) - low) / (high - low), 0.0, 1.0) * static_cast<double>(bins - 1);
      for (std::size_t b = 0; b < bins; ++b)
        variable.bins[b].voltage[r][k] = std::max(0.0, 1 - std::abs(at - static_cast<double>(b)));
    }
  return variable;
}

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double value) { low = std::min(low, value), high = std::max(high, value); }
};

/// For every row the way since the axis last turned, with the sign of the direction and drawn out near 0:
/// +-sqrt(way / far), at most 1.
std::vector<std::vector<double>> since_reversal(const Runs& runs, plant::Axis axis, double far) {
  std::vector<std::vector<double>> all;
  for (const PreparedRun& run : runs) {
    const Motion& motion = run.motion[axis];
    std::vector<double>& since = all.emplace_back();
    double direction = 1, turned_at = motion.position.empty() ? 0 : motion.position[0];
    for (std::size_t k = 0; k < motion.position.size(); ++k) {
      if (direction * motion.rate[k] < -kLeastSpeed) direction = -direction, turned_at = motion.position[k];
      const double way = std::max(0.0, direction * (motion.position[k] - turned_at));
      since.push_back(direction * std::sqrt(std::min(1.0, way / far)));
    }
  }
  return all;
}

std::vector<Variable> variables_of(const Runs& runs, plant::Axis axis) {
  const std::string name = axis == plant::kTrolley ? "trolley" : "slew";
  const auto other = static_cast<std::size_t>(axis == plant::kTrolley ? plant::kSlew : plant::kTrolley);
  Extent position, speed, time;
  for (const PreparedRun& run : runs) {
    for (const double p : run.motion[axis].position) position.take(p);
    for (const double v : run.motion[axis].rate) speed.take(v);
    time.take(run.run.duration_s());
  }
  std::vector<Variable> all;
  all.push_back(binned(name + ": position", axis, runs, 16, position.low, position.high,
                       [&](std::size_t r, std::size_t k) { return runs[r].motion[axis].position[k]; }));
  all.push_back(binned(name + ": speed", axis, runs, 12, speed.low, speed.high,
                       [&](std::size_t r, std::size_t k) { return runs[r].motion[axis].rate[k]; }));
  const auto since = since_reversal(runs, axis, kBuildUp * std::max(1e-3, position.high - position.low));
  all.push_back(binned(name + ": way since the last reversal", axis, runs, 13, -1, 1,
                       [&](std::size_t r, std::size_t k) { return since[r][k]; }));
  // A gain that drifts: the command itself, weighted by time.
  Variable drift =
      binned(name + ": command over time", axis, runs, 5, 0, time.high,
             [&](std::size_t r, std::size_t k) { return static_cast<double>(k) * runs[r].run.period_s; });
  Variable crossed{name + ": command of the other drive", axis, std::vector<Pattern>(1)};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    crossed.bins[0].voltage.emplace_back(runs[r].run.rows());
    for (std::size_t k = 0; k < runs[r].run.rows(); ++k) {
      for (Pattern& bin : drift.bins) bin.voltage[r][k] *= runs[r].run.command_v[k][axis];
      crossed.bins[0].voltage[r][k] = runs[r].run.command_v[k][other];
    }
  }
  all.push_back(std::move(drift));
  all.push_back(std::move(crossed));
  // A force that comes back in time, whatever the crane does.
  for (const double hz : {0.2, 0.3, 0.45, 0.7, 1.0, 1.5, 2.2, 3.3, 5.0}) {
    Variable periodic{name + ": time, about " + std::to_string(hz).substr(0, 4) + " Hz", axis,
                      std::vector<Pattern>(6)};
    for (std::size_t line = 0; line < 3; ++line)
      for (std::size_t r = 0; r < runs.size(); ++r)
        for (const std::size_t phase : {0U, 1U}) {
          auto& voltage = periodic.bins[2 * line + phase].voltage.emplace_back(runs[r].run.rows());
          const double w = 2 * std::numbers::pi * hz * (0.87 + 0.13 * static_cast<double>(line));
          for (std::size_t k = 0; k < voltage.size(); ++k) {
            const double t = runs[r].run.start_s + static_cast<double>(k) * runs[r].run.period_s;
            voltage[k] = phase == 0 ? std::cos(w * t) : std::sin(w * t);
          }
        }
    all.push_back(std::move(periodic));
  }
  return all;
}

/// Response of the drive windows to a pattern: the command with the pattern added, against without.
std::vector<VectorXd> response_to(const Problem& problem, const Crane& crane, const Fits& at,
                                  plant::Axis axis, const Pattern& pattern) {
  Runs changed = problem.runs();
  for (std::size_t r = 0; r < changed.size(); ++r)
    for (std::size_t k = 0; k < changed[r].run.rows(); ++k)
      changed[r].run.command_v[k][axis] += kProbe_v * pattern.voltage[r][k];
  return problem.change_on(changed, crane, at, kProbe_v);
}

/// Decrease of the loss of windows that did not take part in the fit; 0 unless all folds but one agree.
double cross_validated(const Fits& fits, const std::vector<std::vector<VectorXd>>& slopes) {
  const auto n = static_cast<Index>(slopes.size());
  std::vector<MatrixXd> curvature(fits.size());
  std::vector<VectorXd> pull(fits.size());
  MatrixXd all_curvature = MatrixXd::Zero(n, n);
  VectorXd all_pull = VectorXd::Zero(n);
  for (std::size_t w = 0; w < fits.size(); ++w) {
    MatrixXd j(fits[w].residual.size(), n);
    for (Index i = 0; i < n; ++i) j.col(i) = slopes[static_cast<std::size_t>(i)][w];
    const VectorXd weights = weights_of(fits[w].residual);
    curvature[w] = j.transpose() * weights.asDiagonal() * j;
    pull[w] = j.transpose() * weights.cwiseProduct(fits[w].residual);
    all_curvature += curvature[w];
    all_pull += pull[w];
  }
  const double ridge = 1e-3 * all_curvature.trace() / static_cast<double>(n);
  double gain = 0;
  std::size_t agreeing = 0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    MatrixXd h = all_curvature, own_h = MatrixXd::Zero(n, n);
    VectorXd g = all_pull, own_g = VectorXd::Zero(n);
    for (std::size_t w = 0; w < fits.size(); ++w) {
      if (w * kFolds / fits.size() != fold) continue;
      own_h += curvature[w];
      own_g += pull[w];
    }
    h -= own_h;
    g -= own_g;
    h.diagonal().array() += ridge + 1e-12;
    const VectorXd x = h.ldlt().solve(g);
    const double own = 2 * x.dot(own_g) - x.dot(own_h * x);
    gain += own;
    agreeing += own > 0 ? 1 : 0;
  }
  return agreeing + 1 >= kFolds ? gain : 0;
}

}  // namespace

std::vector<Unexplained> find_unexplained(const Study& study, const Effects& effects, const Evaluation& at) {
  std::vector<Unexplained> found;
  const Problem& drive = study.drive();
  if (drive.empty()) return found;
  std::vector<Variable> variables;
  for (const Output output : drive.outputs()) {
    auto more = variables_of(drive.runs(), static_cast<plant::Axis>(output));
    for (Variable& variable : more) variables.push_back(std::move(variable));
  }
  const Crane crane = study.with(effects);
  double drive_loss = 0;
  for (const WindowFit& fit : at.drive) drive_loss += loss_of(fit.residual);
  std::vector<double> gains(variables.size());
  parallel_for(variables.size(), [&](std::size_t v) {
    std::vector<std::vector<VectorXd>> slopes;
    for (const Pattern& bin : variables[v].bins)
      slopes.push_back(response_to(drive, crane, at.drive, variables[v].axis, bin));
    gains[v] = cross_validated(at.drive, slopes);
  });
  for (std::size_t v = 0; v < variables.size(); ++v)
    if (gains[v] > 0) found.push_back({variables[v].name, gains[v], gains[v] / drive_loss, false});
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return found;
}

}  // namespace crane::diagnosis
