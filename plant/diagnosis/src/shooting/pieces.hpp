#pragma once
/// Pieces of one output's residual that a missing force shows in.
///
/// Drives: pieces of the way between two rests. The model at the measured speed, with the measured command
/// and swing, says how the axis accelerates; twice integrated, from a start of its own that is projected
/// away, this leaves of the measured position what a missing force has made, and that is linear in it. When
/// the axis breaks loose, and what friction does where it stands, plays no part.
///
/// Swing: the windows of the load's replay. A pendulum's answer, once free motion is taken out, is the force
/// times a constant.
///
/// Forces are in units of their own: patterns of force are information by their shape.
#include "replay/standstill.hpp"
#include "shooting/problem.hpp"

namespace crane::diagnosis {

struct Piece {
  std::size_t run = 0, first = 0, rows = 0;
  std::vector<double> position;  ///< of a drive by row [m or rad], the errors of its sensor undone
  Whitener whitener;
  Eigen::VectorXd residual;  ///< whitened, without what the start can make
  Eigen::MatrixXd basis;     ///< orthonormal: what the start can make, whitened
};

struct Pieces {
  const Runs* runs = nullptr;
  Output output = kTrolleyPosition;
  Disturbance disturbance;
  std::vector<Piece> all;

  [[nodiscard]] bool of_load() const { return output == kRadialSwing || output == kTangentialSwing; }
  [[nodiscard]] double loss() const;
  [[nodiscard]] double squares() const;
};

/// Of a drive. @param runs outlive the pieces
/// @param known noise and disturbance; learnt from the pieces themselves when its noise is 0
[[nodiscard]] Pieces pieces_of(const Runs& runs, const Replays& crane, Output axis,
                               const Disturbance& known = {});
/// What another crane leaves of each piece of a drive, whitened in the same way, without what the start can
/// make.
[[nodiscard]] std::vector<Eigen::VectorXd> residuals_of(const Pieces& pieces, const Replays& crane);
/// @param problem of the load, its runs outlive the pieces
/// @param output index into its outputs
[[nodiscard]] Pieces pieces_of(const Problem& problem, const Fits& fits, std::size_t output);

/// What forces on a piece, row x pattern, make of its residual: whitened, without what the start can make.
[[nodiscard]] Eigen::MatrixXd response_to(const Pieces& pieces, const Piece& piece, Eigen::MatrixXd forces);

}  // namespace crane::diagnosis
