#pragma once
/// How well patterns of force explain what is left of an output.
#include "shooting/pieces.hpp"

namespace crane::diagnosis {

/// slope' weighted residual and slope' weighted slope.
struct Explained {
  explicit Explained(Eigen::Index patterns = 0)
      : pull(Eigen::VectorXd::Zero(patterns)), curvature(Eigen::MatrixXd::Zero(patterns, patterns)) {}
  Eigen::VectorXd pull;
  Eigen::MatrixXd curvature;
  /// Decrease of the loss that the amplitudes x make.
  [[nodiscard]] double gain(const Eigen::VectorXd& x) const { return 2 * x.dot(pull) - x.dot(curvature * x); }
  Explained& operator+=(const Explained& other);
  Explained& operator-=(const Explained& other);
};

/// Of cosine and sine, the two patterns of a wave, as the residual has them best.
[[nodiscard]] Eigen::Vector2d wave_amplitude(const Explained& wave);

/// @param forces on the piece, row x pattern
[[nodiscard]] Explained explained(const Pieces& pieces, const Piece& piece, Eigen::MatrixXd forces);

}  // namespace crane::diagnosis
