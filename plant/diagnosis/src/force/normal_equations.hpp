#pragma once
/// Least squares of patterns of force on the residual of an output.
#include "shooting/pieces.hpp"

namespace crane::diagnosis {

/// score = J' W e, hessian = J' W J (Gauss-Newton): J whitened responses, e whitened residual, W its robust
/// weights.
struct NormalEquations {
  explicit NormalEquations(Eigen::Index patterns = 0)
      : score(Eigen::VectorXd::Zero(patterns)), hessian(Eigen::MatrixXd::Zero(patterns, patterns)) {}
  Eigen::VectorXd score;
  Eigen::MatrixXd hessian;
  /// Decrease of the loss at amplitudes x.
  [[nodiscard]] double gain(const Eigen::VectorXd& x) const { return 2 * x.dot(score) - x.dot(hessian * x); }
  NormalEquations& operator+=(const NormalEquations& other);
  NormalEquations& operator-=(const NormalEquations& other);
};

/// Least-squares amplitudes of cosine and sine.
[[nodiscard]] Eigen::Vector2d wave_amplitude(const NormalEquations& wave);

/// Eliminates the first `known` patterns (Schur complement). @return equations of the other patterns
[[nodiscard]] NormalEquations beside_first(const NormalEquations& all, Eigen::Index known);

/// @param response of the piece's residual, row x pattern
[[nodiscard]] NormalEquations normal_equations(const Piece& piece, const Eigen::MatrixXd& response);
/// @param forces on the piece, row x pattern
[[nodiscard]] NormalEquations normal_equations(const Pieces& pieces, const Piece& piece,
                                               Eigen::MatrixXd forces);

}  // namespace crane::diagnosis
