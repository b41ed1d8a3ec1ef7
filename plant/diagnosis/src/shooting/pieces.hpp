#pragma once
/// Pieces of the residual of one output that are linear in a missing force.
///
/// Drives: equation error (docs/diagnosis_method.md, 2) between two standstills. The model gives the
/// acceleration at the measured speed, command and swing. This acceleration is integrated twice; the start is
/// projected out. The pieces contain no stick, slip or standstill.
///
/// Swing: windows of the load simulation. Without its free motion, the response of a pendulum is
/// proportional to the force.
///
/// Forces have arbitrary units: only the shape of a pattern counts.
#include "replay/standstill.hpp"
#include "shooting/problem.hpp"

namespace crane::diagnosis {

struct Piece {
  std::size_t run = 0, first = 0, rows = 0;
  std::vector<double> position;  ///< of a drive by row [m or rad], sensor terms inverted
  Whitener whitener;
  Eigen::VectorXd residual;  ///< whitened, start projected out
  Eigen::MatrixXd basis;     ///< orthonormal, whitened: directions of the start
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

/// Pieces of a drive. @param runs outlive the pieces
/// @param known disturbance; noise 0: learnt from the pieces
[[nodiscard]] Pieces pieces_of(const Runs& runs, const Replays& crane, Output axis,
                               const Disturbance& known = {});
/// Disturbance of the pieces of a drive. @param near  disturbance of a similar residual, with which the
/// search begins; noise 0: none is known
[[nodiscard]] Disturbance disturbance_of(const Runs& runs, const Replays& crane, Output axis,
                                         const Disturbance& near);
/// Residuals of another crane on the pieces of a drive, not whitened, m or rad.
[[nodiscard]] std::vector<Eigen::VectorXd> plain_residuals_of(const Pieces& pieces, const Replays& crane);
/// Residuals or slopes by piece of a drive, whitened like the pieces, start projected out.
[[nodiscard]] std::vector<Eigen::VectorXd> whitened(const Pieces& pieces,
                                                    std::vector<Eigen::VectorXd> residuals);
/// Whitened residuals of another crane on the pieces of a drive.
[[nodiscard]] std::vector<Eigen::VectorXd> residuals_of(const Pieces& pieces, const Replays& crane);
/// Pieces of a swing. @param problem of the load; its runs outlive the pieces
/// @param output index into its outputs
[[nodiscard]] Pieces pieces_of(const Problem& problem, const Fits& fits, std::size_t output);

/// Response of the residual to forces on a piece (row x pattern): whitened, start projected out.
[[nodiscard]] Eigen::MatrixXd response_to(const Pieces& pieces, const Piece& piece, Eigen::MatrixXd forces);

}  // namespace crane::diagnosis
