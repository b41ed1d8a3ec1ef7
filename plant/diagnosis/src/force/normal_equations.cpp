#include "force/normal_equations.hpp"

#include <utility>

#include "robust.hpp"

namespace crane::diagnosis {
namespace {

/// Keep equations solvable when a pattern is zero or two patterns are equal: share of a diagonal element, and
/// the least addition.
constexpr double kRidge = 1e-9, kLeastDiagonal = 1e-12;

}  // namespace

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
  const Eigen::Matrix2d regular = h + (kRidge * h.trace() + kLeastDiagonal) * Eigen::Matrix2d::Identity();
  return regular.inverse() * wave.score;
}

NormalEquations beside_first(const NormalEquations& all, Eigen::Index known) {
  const Eigen::Index fresh = all.score.size() - known;
  Eigen::MatrixXd own = all.hessian.topLeftCorner(known, known);
  own.diagonal().array() += kRidge * own.diagonal().array() + kLeastDiagonal;
  const Eigen::MatrixXd cross = all.hessian.topRightCorner(known, fresh);
  const Eigen::MatrixXd share = own.ldlt().solve(cross);
  NormalEquations rest{fresh};
  rest.score = all.score.tail(fresh) - share.transpose() * all.score.head(known);
  rest.hessian = all.hessian.bottomRightCorner(fresh, fresh) - cross.transpose() * share;
  return rest;
}

NormalEquations normal_equations(const Piece& piece, const Eigen::MatrixXd& response) {
  const Eigen::VectorXd weights = weights_of(piece.residual);
  NormalEquations all;
  all.score = response.transpose() * weights.cwiseProduct(piece.residual);
  all.hessian = response.transpose() * weights.asDiagonal() * response;
  return all;
}

NormalEquations normal_equations(const Pieces& pieces, const Piece& piece, Eigen::MatrixXd forces) {
  return normal_equations(piece, response_to(pieces, piece, std::move(forces)));
}

}  // namespace crane::diagnosis
