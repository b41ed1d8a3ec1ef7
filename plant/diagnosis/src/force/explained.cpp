#include "force/explained.hpp"

#include "robust.hpp"

namespace crane::diagnosis {

Explained& Explained::operator+=(const Explained& other) {
  pull += other.pull;
  curvature += other.curvature;
  return *this;
}

Explained& Explained::operator-=(const Explained& other) {
  pull -= other.pull;
  curvature -= other.curvature;
  return *this;
}

Eigen::Vector2d wave_amplitude(const Explained& wave) {
  const Eigen::Matrix2d h = wave.curvature;
  const Eigen::Matrix2d regular = h + (1e-9 * h.trace() + 1e-12) * Eigen::Matrix2d::Identity();
  return regular.inverse() * wave.pull;
}

Explained explained(const Pieces& pieces, const Piece& piece, Eigen::MatrixXd forces) {
  const Eigen::MatrixXd made = made_by(pieces, piece, std::move(forces));
  const Eigen::VectorXd weights = weights_of(piece.residual);
  Explained all;
  all.pull = made.transpose() * weights.cwiseProduct(piece.residual);
  all.curvature = made.transpose() * weights.asDiagonal() * made;
  return all;
}

}  // namespace crane::diagnosis
