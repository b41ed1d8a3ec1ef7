#include "shooting/pieces.hpp"

#include <algorithm>
#include <cmath>

#include "noise/learning.hpp"
#include "noise/motion_profile.hpp"
#include "parallel.hpp"
#include "robust.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A shorter piece is not used, because its start explains all of it. A longer piece is divided.
constexpr double kShortestPiece_s = 0.15, kLongestPiece_s = 2;
/// Position and speed at the start explain two rows.
constexpr std::size_t kFewestRows = 3;
/// The speed is unknown in a gap that is longer than both: s; usual row spacings.
constexpr double kUnknownSpeed_s = 0.1, kUnknownRows = 2.5;

struct MovingStretch {
  std::size_t run = 0, first = 0, rows = 0;
  std::vector<double> position;
};

/// Rows inside gaps, where the motion is that of the spline.
std::vector<bool> unknown_rows(const Run& run, Output axis) {
  std::vector<bool> unknown(run.rows(), false);
  if (run.regular(axis)) return unknown;
  const double longest_s = std::max(kUnknownSpeed_s, kUnknownRows * usual_row_spacing_s(run, axis));
  for (std::size_t row = 0, after = 0; row < run.rows(); ++row) {
    if (!run.is_measured(axis, row)) continue;
    if (run.instant_s(row) - (after > 0 ? run.instant_s(after - 1) : 0) > longest_s)
      std::fill(unknown.begin() + static_cast<std::ptrdiff_t>(after),
                unknown.begin() + static_cast<std::ptrdiff_t>(row), true);
    after = row + 1;
  }
  return unknown;
}

/// Stretches in which the axis moves without a rest.
std::vector<MovingStretch> moving_stretches(const PreparedRun& run, std::size_t number, Output axis) {
  const std::vector<double>& rate = run.motion[axis].rate;
  const auto shortest = std::max(kFewestRows, static_cast<std::size_t>(kShortestPiece_s / run.run.period_s));
  const auto longest = static_cast<std::size_t>(kLongestPiece_s / run.run.period_s);
  const std::vector<bool> unknown = unknown_rows(run.run, axis);
  std::vector<MovingStretch> all;
  for (std::size_t first = 0, row = 0; row <= rate.size(); ++row) {
    const bool moves = row < rate.size() && std::abs(rate[row]) >= kStandstillSpeed && !unknown[row];
    const bool goes_on = moves && (row == first || rate[row] * rate[row - 1] > 0);
    if (goes_on) continue;
    const std::size_t rows = row - first, count = (rows + longest - 1) / longest;
    for (std::size_t piece = 0; rows >= shortest && piece < count; ++piece)
      all.push_back({number, first + piece * rows / count, rows / count, {}});
    first = row + (moves ? 0 : 1);
  }
  return all;
}

/// In place, from rest; each acceleration lasts one row.
void integrate_twice(MatrixXd& x, double period_s) {
  Eigen::RowVectorXd distance = Eigen::RowVectorXd::Zero(x.cols()), speed = distance;
  for (Index k = 0; k < x.rows(); ++k) {
    const Eigen::RowVectorXd acceleration = x.row(k);
    x.row(k) = distance;
    distance += period_s * (speed + 0.5 * period_s * acceleration);
    speed += period_s * acceleration;
  }
}

/// Distance of the model from rest at `first`, at the rows' own times, by the increments of each row.
VectorXd model_distance(const Run& run, const Replay::Increments& drive, std::size_t first,
                        std::size_t row_count) {
  VectorXd distance(static_cast<Index>(row_count));
  std::vector<double> position{0}, speed{0};
  for (std::size_t k = 0; k < row_count; ++k) {
    distance[static_cast<Index>(k)] = position[k];
    position.push_back(position[k] + run.period_s * speed[k] + drive.distance[first + k]);
    speed.push_back(speed[k] + drive.speed_change[first + k]);
  }
  if (run.offset_s.empty()) return distance;
  for (std::size_t k = 0; k < row_count; ++k) {
    const double offset_s = run.offset_s[first + k];
    const std::size_t from = offset_s < 0 && k > 0 ? k - 1 : k;
    const double t = from < k ? offset_s + run.period_s : offset_s, share = t / run.period_s;
    distance[static_cast<Index>(k)] =
        position[from] + t * speed[from] + share * share * drive.distance[first + from];
  }
  return distance;
}

/// Residual of a piece in units of the sensor value: in other units, a fitted scale of the sensor could
/// reduce it. 0 in missing rows.
VectorXd piece_residual(const PreparedRun& run, const Replay::Increments& drive, Output axis,
                        std::size_t first, std::size_t row_count) {
  const auto rows = static_cast<Index>(row_count);
  const VectorXd distance = model_distance(run.run, drive, first, row_count);
  const std::vector<double>&shown = run.motion[axis].position, &true_position = drive.position;
  const std::size_t last = first + row_count - 1;
  const double scale = (shown[last] - shown[first]) / (true_position[last] - true_position[first]);
  VectorXd left = VectorXd::Zero(rows);
  for (std::size_t k = 0; k < row_count; ++k) {
    if (!run.run.is_measured(axis, first + k)) continue;
    const double noise = run.run.measured[axis][first + k] - shown[first + k];
    left[static_cast<Index>(k)] =
        noise + scale * (true_position[first + k] - distance[static_cast<Index>(k)]);
  }
  return left;
}

WindowMotion window_motion_of(const PreparedRun& run, const MovingStretch& at, Output axis) {
  WindowMotion motion{run.run.period_s, 0, motion_profile_of(run, axis, at.first, at.rows)};
  for (RowMotion& row : motion.profile) row.phase = MotionPhase::moving;
  return motion;
}

/// Orthonormal directions of the start: whitened changes by position and speed at the start, at the measured
/// times of the rows.
MatrixXd start_basis(const Whitener& whitener, const Run& run, std::size_t first, std::size_t rows) {
  MatrixXd directions(static_cast<Index>(rows), 2);
  directions.col(0).setOnes();
  for (std::size_t k = 0; k < rows; ++k)
    directions(static_cast<Index>(k), 1) = run.instant_s(first + k) - run.instant_s(first);
  whitener.apply(directions);
  return Eigen::HouseholderQR<MatrixXd>(directions).householderQ() *
         MatrixXd::Identity(directions.rows(), directions.cols());
}

/// Whitens the residual and projects the start out.
void marginalise_start(const Piece& piece, VectorXd& residual) {
  piece.whitener.apply(residual);
  residual -= piece.basis * (piece.basis.transpose() * residual).eval();
}

/// The moving stretches of all runs, with their residuals.
struct Stretches {
  std::vector<MovingStretch> all;
  std::vector<VectorXd> residuals;
  std::vector<WindowMotion> motions;
};

Stretches stretches_of(const Runs& runs, const Replays& crane, Output axis) {
  Stretches found;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (!runs[r].run.has(axis)) continue;
    const Replay::Increments& drive = crane[r].increments_along_measurement(axis);
    for (MovingStretch& stretch : moving_stretches(runs[r], r, axis)) {
      const auto from = drive.position.begin() + static_cast<std::ptrdiff_t>(stretch.first);
      stretch.position.assign(from, from + static_cast<std::ptrdiff_t>(stretch.rows));
      found.residuals.push_back(piece_residual(runs[r], drive, axis, stretch.first, stretch.rows));
      found.motions.push_back(window_motion_of(runs[r], stretch, axis));
      found.all.push_back(std::move(stretch));
    }
  }
  return found;
}

}  // namespace

double Pieces::loss() const {
  double sum = 0;
  for (const Piece& piece : all) sum += loss_of(piece.residual);
  return sum;
}

double Pieces::squares() const {
  double sum = 0;
  for (const Piece& piece : all) sum += piece.residual.squaredNorm();
  return sum;
}

Pieces pieces_of(const Runs& runs, const Replays& crane, Output axis, const Disturbance& known) {
  Stretches stretches = stretches_of(runs, crane, axis);
  Pieces pieces{&runs, axis, known, {}};
  if (stretches.all.empty()) return pieces;
  if (!(known.noise > 0))
    pieces.disturbance = learn(stretches.residuals, stretches.motions, least_noise_of(runs, axis));
  for (std::size_t i = 0; i < stretches.all.size(); ++i) {
    auto& [run, first, rows, position] = stretches.all[i];
    Piece piece{run,
                first,
                rows,
                std::move(position),
                Whitener(pieces.disturbance, stretches.motions[i]),
                std::move(stretches.residuals[i]),
                {}};
    piece.basis = start_basis(piece.whitener, runs[run].run, first, rows);
    marginalise_start(piece, piece.residual);
    pieces.all.push_back(std::move(piece));
  }
  return pieces;
}

Disturbance disturbance_of(const Runs& runs, const Replays& crane, Output axis, const Disturbance& near) {
  const Stretches stretches = stretches_of(runs, crane, axis);
  if (stretches.all.empty()) return {};
  return learn(stretches.residuals, stretches.motions, least_noise_of(runs, axis), near);
}

std::vector<VectorXd> plain_residuals_of(const Pieces& pieces, const Replays& crane) {
  const Runs& runs = *pieces.runs;
  std::vector<VectorXd> residuals(pieces.all.size());
  parallel_for(runs.size(), [&](std::size_t r) {
    if (!runs[r].run.has(pieces.output)) return;
    const Replay::Increments& drive = crane[r].increments_along_measurement(pieces.output);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const Piece& piece = pieces.all[i];
      if (piece.run != r) continue;
      residuals[i] = piece_residual(runs[r], drive, pieces.output, piece.first, piece.rows);
    }
  });
  return residuals;
}

std::vector<VectorXd> whitened(const Pieces& pieces, std::vector<VectorXd> residuals) {
  for (std::size_t i = 0; i < residuals.size(); ++i) marginalise_start(pieces.all[i], residuals[i]);
  return residuals;
}

std::vector<VectorXd> residuals_of(const Pieces& pieces, const Replays& crane) {
  return whitened(pieces, plain_residuals_of(pieces, crane));
}

Pieces pieces_of(const Problem& problem, const Fits& fits, std::size_t output) {
  Pieces pieces{&problem.runs(), problem.outputs()[output], problem.disturbances()[output], {}};
  for (std::size_t w = 0; w < fits.size(); ++w) {
    const Window& window = problem.windows()[w];
    const auto rows = static_cast<Index>(window.rows), from = static_cast<Index>(output) * rows;
    pieces.all.push_back({window.run,
                          window.first,
                          window.rows,
                          {},
                          problem.whitener(output, w),
                          fits[w].residual.segment(from, rows),
                          fits[w].basis.middleRows(from, rows)});
  }
  return pieces;
}

MatrixXd response_to(const Pieces& pieces, const Piece& piece, MatrixXd forces) {
  if (!pieces.of_load()) integrate_twice(forces, (*pieces.runs)[piece.run].run.period_s);
  piece.whitener.apply(forces);
  forces -= piece.basis * (piece.basis.transpose() * forces).eval();
  return forces;
}

}  // namespace crane::diagnosis
