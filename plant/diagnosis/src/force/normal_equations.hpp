#pragma once
/// How well patterns of force explain what is left of an output.
#include "shooting/pieces.hpp"

namespace crane::diagnosis {

/// slope' weighted residual and slope' weighted slope.
struct NormalEquations {
  explicit NormalEquations(Eigen::Index patterns = 0)
      : score(Eigen::VectorXd::Zero(patterns)), hessian(Eigen::MatrixXd::Zero(patterns, patterns)) {}
  Eigen::VectorXd score;
  Eigen::MatrixXd hessian;
  /// Decrease of the loss that the amplitudes x make.
  [[nodiscard]] double gain(const Eigen::VectorXd& x) const { return 2 * x.dot(score) - x.dot(hessian * x); }
  NormalEquations& operator+=(const NormalEquations& other);
  NormalEquations& operator-=(const NormalEquations& other);
};

/// Of cosine and sine, the two patterns of a wave, as the residual has them best.
[[nodiscard]] Eigen::Vector2d wave_amplitude(const NormalEquations& wave);

/// @param forces on the piece, row x pattern
[[nodiscard]] NormalEquations normal_equations(const Pieces& pieces, const Piece& piece,
                                               Eigen::MatrixXd forces);

}  // namespace crane::diagnosis
