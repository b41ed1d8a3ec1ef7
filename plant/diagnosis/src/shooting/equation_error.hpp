#pragma once
/// Equation error of the drives (pieces.hpp): a residual that does not depend on the time of stick and slip,
/// in addition to the residual of the drive simulation.
#include "shooting/pieces.hpp"

namespace crane::diagnosis {

/// Immutable.
class EquationError {
 public:
  /// Without pieces. @param drive  problem of the same runs; must outlive this object
  explicit EquationError(const Problem& drive) : drive_(drive) {}
  /// Whitened with the disturbance of each axis that the residual of `crane` contains.
  EquationError(const Problem& drive, const Replays& crane);
  /// Whitened with these disturbances, by output of the drives. @param crane  any crane on these runs
  EquationError(const Problem& drive, const std::vector<Disturbance>& disturbances, const Replays& crane);
  [[nodiscard]] std::vector<Disturbance> disturbances() const;
  /// Disturbances of the residual of `crane`, by output of the drives. @param near  disturbances of a similar
  /// residual, with which the search begins; empty: none are known
  [[nodiscard]] std::vector<Disturbance> disturbances_of(const Replays& crane,
                                                         const std::vector<Disturbance>& near = {}) const;

  /// Whitened residual of each piece, start projected out.
  [[nodiscard]] std::vector<Eigen::VectorXd> residuals(const Replays& crane) const;
  /// Slopes by a finite difference: (`at` - residuals(crane)) / `step`.
  [[nodiscard]] std::vector<Eigen::VectorXd> change(const Replays& crane,
                                                    const std::vector<Eigen::VectorXd>& at,
                                                    double step) const;
  /// Residual of each piece, not whitened.
  [[nodiscard]] std::vector<Eigen::VectorXd> plain_residuals(const Replays& crane) const;
  /// Whitens plain residuals or slopes by piece; projects the start out.
  [[nodiscard]] std::vector<Eigen::VectorXd> whitened(const std::vector<Eigen::VectorXd>& plain) const;
  /// Sum of ln f of each piece.
  [[nodiscard]] std::vector<double> log_variances() const;
  /// Window of the drive simulation that each piece belongs to.
  [[nodiscard]] const std::vector<std::size_t>& windows() const { return windows_; }

 private:
  void find_windows();

  const Problem& drive_;
  std::vector<Pieces> axes_;
  std::vector<std::size_t> windows_;
};

}  // namespace crane::diagnosis
