#include "force/unexplained.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "force/bins.hpp"
#include "force/cross_validation.hpp"
#include "parallel.hpp"
#include "replay/travel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Share of the travel within which a force builds up after a reversal.
constexpr double kBuildUp = 0.25;

/// Least travel of the other axis for a pattern over its position, m or rad.
constexpr double kLeastTravel = 0.05;

/// Function of run and row.
using RowFunction = std::function<double(std::size_t, std::size_t)>;

/// Force as a function of `value`: an amplitude for each triangular bin over its range, times `force`.
struct Variable {
  std::string name;
  GoesWith with = GoesWith::position;
  std::size_t bins = 1;
  Extent over;
  RowFunction value, force;
};

/// By row: +-sqrt(distance since the last reversal / far), at most 1, with the sign of the direction.
std::vector<std::vector<double>> since_reversal(const Runs& runs, Output axis, double far) {
  std::vector<std::vector<double>> all;
  for (const PreparedRun& run : runs) {
    const Motion& motion = run.motion[axis];
    std::vector<double>& since = all.emplace_back();
    double direction = 1, turned_at = motion.position.empty() ? 0 : motion.position[0];
    for (std::size_t k = 0; k < motion.position.size(); ++k) {
      if (direction * motion.rate[k] < -kStandstillSpeed)
        direction = -direction, turned_at = motion.position[k];
      const double distance = std::max(0.0, direction * (motion.position[k] - turned_at));
      since.push_back(direction * std::sqrt(std::min(1.0, distance / far)));
    }
  }
  return all;
}

/// Whether the motion of an axis is known in all runs, and the axis moves.
bool moves(const Runs& runs, Output axis) {
  return std::ranges::all_of(
             runs,
             [axis](const PreparedRun& run) { return run.motion[axis].position.size() == run.run.rows(); }) &&
         travel_of(runs, axis).width() > kLeastTravel;
}

std::vector<Variable> variables_of(const Runs& runs, Output axis) {
  const std::string name = axis_of(axis);
  const std::size_t other = axis == kTrolleyPosition ? plant::kSlew : plant::kTrolley;
  const Extent travel = travel_of(runs, axis);
  Extent speeds, times{0, 0};
  for (const PreparedRun& run : runs) {
    for (const double v : run.motion[axis].rate) speeds.take(v);
    times.take(run.run.duration_s());
  }
  const RowFunction position = [&runs, axis](auto r, auto k) { return runs[r].motion[axis].position[k]; };
  const RowFunction speed = [&runs, axis](auto r, auto k) { return runs[r].motion[axis].rate[k]; };
  const RowFunction time = [&runs](auto r, auto k) { return static_cast<double>(k) * runs[r].run.period_s; };
  const RowFunction since = [all = since_reversal(runs, axis, kBuildUp * std::max(1e-3, travel.width()))](
                                auto r, auto k) { return all[r][k]; };
  const RowFunction push = [](auto, auto) { return 1.0; };
  const RowFunction friction = [speed](auto r, auto k) { return std::copysign(1.0, speed(r, k)); };
  const RowFunction command = [&runs, axis](auto r, auto k) { return runs[r].run.command_v[k][axis]; };
  const RowFunction other_command = [&runs, other](auto r, auto k) {
    return runs[r].run.command_v[k][other];
  };
  std::vector<Variable> all{
      {name + ": position", GoesWith::position, 16, travel, position, push},
      {name + ": position, closely", GoesWith::position, 64, travel, position, push},
      {name + ": speed", GoesWith::speed, 12, speeds, speed, push},
      {name + ": distance since the last reversal", GoesWith::reversals, 13, {-1, 1}, since, push},
      {name + ": friction by position", GoesWith::position, 16, travel, position, friction},
      {name + ": friction over time", GoesWith::time, 5, times, time, friction},
      {name + ": command over time", GoesWith::time, 5, times, time, command},
      {name + ": command of the other drive", GoesWith::other_command, 1, times, time, other_command}};
  const Output other_axis = axis == kTrolleyPosition ? kSlewAngle : kTrolleyPosition;
  if (!moves(runs, other_axis)) return all;
  const Extent other_travel = travel_of(runs, other_axis);
  const RowFunction other_position = [&runs, other_axis](auto r, auto k) {
    return runs[r].motion[other_axis].position[k];
  };
  for (const auto& [what, force] :
       {std::pair{": position of the ", push}, {": friction by position of the ", friction}})
    all.push_back({name + what + axis_of(other_axis), GoesWith::other_position, 8, other_travel,
                   other_position, force});
  return all;
}

/// Forces of a piece, row x bin.
MatrixXd forces_of(const Piece& piece, const Variable& variable) {
  MatrixXd forces(static_cast<Index>(piece.rows), static_cast<Index>(variable.bins));
  for (Index k = 0; k < forces.rows(); ++k) {
    const std::size_t row = piece.first + static_cast<std::size_t>(k);
    const double share = (variable.value(piece.run, row) - variable.over.low) / variable.over.width();
    forces.row(k) = variable.force(piece.run, row) * triangular_bins(share, variable.bins);
  }
  return forces;
}

/// One pattern per bin, by piece.
std::vector<NormalEquations> normal_equations_of(const Pieces& pieces, const Variable& variable) {
  std::vector<NormalEquations> all;
  all.reserve(pieces.all.size());
  for (const Piece& piece : pieces.all)
    all.push_back(normal_equations(pieces, piece, forces_of(piece, variable)));
  return all;
}

NormalEquations total(const std::vector<NormalEquations>& pieces) {
  NormalEquations all{pieces[0].score.size()};
  for (const NormalEquations& piece : pieces) all += piece;
  return all;
}

/// Rms over the rows of the fitted acceleration.
double rms_acceleration(const Pieces& pieces, const Variable& variable) {
  NormalEquations all = total(normal_equations_of(pieces, variable));
  all.hessian.diagonal().array() += ridge_of(all);
  const VectorXd amplitudes = all.hessian.ldlt().solve(all.score);
  double squares = 0, count = 0;
  for (const Piece& piece : pieces.all) {
    squares += (forces_of(piece, variable) * amplitudes).squaredNorm();
    count += static_cast<double>(piece.rows);
  }
  return std::sqrt(squares / count);
}

/// Decrease of the loss of pieces outside the fit.
double cross_validated_gain(const std::vector<NormalEquations>& pieces) {
  const Index n = pieces[0].score.size();
  const NormalEquations all = total(pieces);
  const double ridge = ridge_of(all);
  std::array<double, kFolds> gains{};
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    NormalEquations own{n}, others = all;
    for (std::size_t w = 0; w < pieces.size(); ++w)
      if (w * kFolds / pieces.size() == fold) own += pieces[w];
    others -= own;
    others.hessian.diagonal().array() += ridge;
    gains[fold] = own.gain(others.hessian.ldlt().solve(others.score));
  }
  return gain_of_folds(gains);
}

/// Cross-validated gain; of a pattern over time or over the position of the other axis, beyond that of a
/// constant.
double pattern_gain_of(const Pieces& pieces, const Variable& variable) {
  const double gain = cross_validated_gain(normal_equations_of(pieces, variable));
  const bool beyond_a_constant = variable.with == GoesWith::time || variable.with == GoesWith::other_position;
  if (!beyond_a_constant || gain <= 0) return gain;
  Variable constant = variable;
  constant.bins = 1;
  return gain - std::max(0.0, cross_validated_gain(normal_equations_of(pieces, constant)));
}

}  // namespace

std::vector<Unexplained> find_unexplained(const Pieces& pieces) {
  std::vector<Unexplained> found;
  if (pieces.all.empty()) return found;
  const std::vector<Variable> variables = variables_of(*pieces.runs, pieces.output);
  const double loss = pieces.loss();
  std::vector<double> gains(variables.size());
  parallel_for(variables.size(), [&](std::size_t v) { gains[v] = pattern_gain_of(pieces, variables[v]); });
  // Axes that move together have correlated positions: a pattern over the own position explains its part.
  double by_own_position = 0;
  for (std::size_t v = 0; v < variables.size(); ++v)
    if (variables[v].with == GoesWith::position) by_own_position = std::max(by_own_position, gains[v]);
  for (std::size_t v = 0; v < variables.size(); ++v)
    if (variables[v].with == GoesWith::other_position) gains[v] -= by_own_position;
  for (std::size_t v = 0; v < variables.size(); ++v)
    if (gains[v] > 0)
      found.push_back({variables[v].name, variables[v].with, pieces.output, gains[v], gains[v] / loss,
                       rms_acceleration(pieces, variables[v])});
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return found;
}

}  // namespace crane::diagnosis
