#include "force/jumps.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "parallel.hpp"
#include "robust.hpp"
#include "rules.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rows at the ends of a piece, where a jump resembles another start.
constexpr std::size_t kJumpMargin_rows = 5;

/// Whitens columns and removes the part that the start of the piece explains.
void apply_piece(const Piece& piece, MatrixXd& columns) {
  piece.whitener.apply(columns);
  columns -= piece.basis * (piece.basis.transpose() * columns).eval();
}

/// Orthonormal basis of the residuals that an error of the acceleration causes which is linear in time. A
/// friction that differs from the model at low speed causes such an error, and a change of speed would
/// describe it better than no change.
MatrixXd smooth_errors(const Piece& piece, const Run& run) {
  const auto rows = static_cast<Index>(piece.rows);
  MatrixXd powers(rows, 2);
  for (Index k = 0; k < rows; ++k) {
    const double t = run.instant_s(piece.first + static_cast<std::size_t>(k)) - run.instant_s(piece.first);
    powers(k, 0) = t * t, powers(k, 1) = t * t * t;
  }
  apply_piece(piece, powers);
  return powers.householderQr().householderQ() * MatrixXd::Identity(rows, 2);
}

/// One column per row at which the position, or the speed, may jump.
MatrixXd jumps_in(const Piece& piece, const Run& run, bool of_speed) {
  const auto rows = static_cast<Index>(piece.rows), margin = static_cast<Index>(kJumpMargin_rows);
  MatrixXd all = MatrixXd::Zero(rows, std::max<Index>(0, rows - 2 * margin));
  const auto instant_s = [&](Index row) {
    return run.instant_s(piece.first + static_cast<std::size_t>(row));
  };
  for (Index j = 0; j < all.cols(); ++j)
    for (Index k = j + margin; k < rows; ++k)
      all(k, j) = of_speed ? instant_s(k) - instant_s(j + margin - 1) : 1.0;
  apply_piece(piece, all);
  return all;
}

double strongest_jump(const Piece& piece, const Run& run, bool of_speed) {
  MatrixXd all = jumps_in(piece, run, of_speed);
  if (all.cols() == 0) return 0;
  const MatrixXd smooth = smooth_errors(piece, run);
  all -= smooth * (smooth.transpose() * all).eval();
  const VectorXd score = all.transpose() * piece.residual, hessian = all.colwise().squaredNorm();
  return (score.cwiseAbs2().array() / hessian.array().max(1e-12)).maxCoeff();
}

}  // namespace

std::optional<Unexplained> find_jumps(const Pieces& pieces) {
  struct Strongest {
    double of_position = 0, of_speed = 0;
  };
  std::vector<Strongest> found(pieces.all.size());
  parallel_for(found.size(), [&](std::size_t i) {
    const Piece& piece = pieces.all[i];
    const Run& run = (*pieces.runs)[piece.run].run;
    found[i] = {strongest_jump(piece, run, false), strongest_jump(piece, run, true)};
  });
  std::size_t clear = 0;
  double gain = 0, rather_position = 0;
  for (const auto& [of_position, of_speed] : found) {
    const double stronger = std::max(of_position, of_speed);
    if (stronger < rules::kClearJumpStatistic) continue;
    ++clear;
    gain += loss_of(std::sqrt(stronger));
    rather_position += of_position - of_speed;
  }
  if (clear < rules::kFewestJumpingPieces.count()) return std::nullopt;
  const std::string axis = axis_of(pieces.output);
  return Unexplained{axis + (rather_position > 0 ? ": jumps of the position, " : ": jumps of the speed, ") +
                         std::to_string(clear) + " in " + std::to_string(found.size()) + " motions",
                     GoesWith::jumps, pieces.output, gain, gain / pieces.loss()};
}

}  // namespace crane::diagnosis
