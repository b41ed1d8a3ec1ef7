#include "force/normal_equations.hpp"

#include "robust.hpp"

namespace crane::diagnosis {

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  score += other.score;
  hessian += other.hessian;
  return *this;
}

NormalEquations& NormalEquations::operator-=(const NormalEquations& other) {
  score -= other.score;
  hessian -= other.hessian;
  return *this;
}

Eigen::Vector2d wave_amplitude(const NormalEquations& wave) {
  const Eigen::Matrix2d h = wave.hessian;
  const Eigen::Matrix2d regular = h + (1e-9 * h.trace() + 1e-12) * Eigen::Matrix2d::Identity();
  return regular.inverse() * wave.score;
}

NormalEquations normal_equations(const Pieces& pieces, const Piece& piece, Eigen::MatrixXd forces) {
  const Eigen::MatrixXd response = response_to(pieces, piece, std::move(forces));
  const Eigen::VectorXd weights = weights_of(piece.residual);
  NormalEquations all;
  all.score = response.transpose() * weights.cwiseProduct(piece.residual);
  all.hessian = response.transpose() * weights.asDiagonal() * response;
  return all;
}

}  // namespace crane::diagnosis
