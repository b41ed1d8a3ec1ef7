#include "force/unexplained.hpp"

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
      if (std::abs(runs[r].motion[axis].rate[k]) < kStands) continue;
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
      if (direction * motion.rate[k] < -kStands) direction = -direction, turned_at = motion.position[k];
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
  all.push_back(binned(name + ": position, closely", axis, runs, 64, position.low, position.high,
                       [&](std::size_t r, std::size_t k) { return runs[r].motion[axis].position[k]; }));
  all.push_back(binned(name + ": speed", axis, runs, 12, speed.low, speed.high,
                       [&](std::size_t r, std::size_t k) { return runs[r].motion[axis].rate[k]; }));
  // Friction that is elsewhere another one, or at another time.
  Variable tight = binned(name + ": friction by position", axis, runs, 16, position.low, position.high,
                          [&](std::size_t r, std::size_t k) { return runs[r].motion[axis].position[k]; });
  Variable wear =
      binned(name + ": friction over time", axis, runs, 5, 0, time.high,
             [&](std::size_t r, std::size_t k) { return static_cast<double>(k) * runs[r].run.period_s; });
  for (Variable* friction : {&tight, &wear}) {
    for (Pattern& bin : friction->bins)
      for (std::size_t r = 0; r < runs.size(); ++r)
        for (std::size_t k = 0; k < runs[r].run.rows(); ++k)
          bin.voltage[r][k] = std::copysign(bin.voltage[r][k], runs[r].motion[axis].rate[k]);
    all.push_back(std::move(*friction));
  }
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
  return all;
}

/// Of every piece, one column a bin.
std::vector<Explained> explained_by(const Pieces& pieces, const Variable& variable) {
  std::vector<Explained> all;
  for (const Piece& piece : pieces.all) {
    MatrixXd forces(static_cast<Index>(piece.rows), static_cast<Index>(variable.bins.size()));
    for (std::size_t bin = 0; bin < variable.bins.size(); ++bin)
      forces.col(static_cast<Index>(bin)) = Eigen::Map<const VectorXd>(
          &variable.bins[bin].voltage[piece.run][piece.first], static_cast<Index>(piece.rows));
    all.push_back(explained(pieces, piece, std::move(forces)));
  }
  return all;
}

/// Decrease of the loss of pieces that did not take part in the fit; 0 unless all folds but one agree.
double cross_validated(const std::vector<Explained>& pieces) {
  const Index n = pieces[0].pull.size();
  Explained all{n};
  for (const Explained& piece : pieces) all += piece;
  const double ridge = 1e-3 * all.curvature.trace() / static_cast<double>(n);
  double gain = 0;
  std::size_t agreeing = 0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    Explained own{n}, others = all;
    for (std::size_t w = 0; w < pieces.size(); ++w)
      if (w * kFolds / pieces.size() == fold) own += pieces[w];
    others -= own;
    others.curvature.diagonal().array() += ridge + 1e-12;
    const double gained = own.gain(others.curvature.ldlt().solve(others.pull));
    gain += gained;
    agreeing += gained > 0 ? 1 : 0;
  }
  return agreeing + 1 >= kFolds ? gain : 0;
}

}  // namespace

std::vector<Unexplained> find_unexplained(const Pieces& pieces) {
  std::vector<Unexplained> found;
  if (pieces.all.empty()) return found;
  const std::vector<Variable> variables = variables_of(*pieces.runs, static_cast<plant::Axis>(pieces.output));
  const double loss = pieces.loss();
  std::vector<double> gains(variables.size());
  parallel_for(variables.size(),
               [&](std::size_t v) { gains[v] = cross_validated(explained_by(pieces, variables[v])); });
  for (std::size_t v = 0; v < variables.size(); ++v)
    if (gains[v] > 0) found.push_back({variables[v].name, gains[v], gains[v] / loss, false});
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return found;
}

}  // namespace crane::diagnosis
