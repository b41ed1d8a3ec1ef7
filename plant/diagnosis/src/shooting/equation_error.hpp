#pragma once
/// The drives along the measured motion, between two rests (pieces.hpp): the part of the residual that
/// does not hang on when exactly an axis breaks loose, beside the windows of the drives' replay.
#include "shooting/pieces.hpp"

namespace crane::diagnosis {

class EquationError {
 public:
  /// @param drive of the same runs; outlives this
  explicit EquationError(const Problem& drive) : drive_(drive) {}

  /// Learns noise and disturbance of each axis from what `crane` leaves, and whitens with them from now on.
  void learn_disturbance(const Replays& crane);
  /// Whitens with these, by output of the drives, from now on. @param crane any of these runs
  void whiten_with(const std::vector<Disturbance>& disturbances, const Replays& crane);
  [[nodiscard]] std::vector<Disturbance> disturbances() const;
  /// Of what another crane leaves, by output of the drives, whatever was learnt before.
  [[nodiscard]] std::vector<Disturbance> disturbances_of(const Replays& crane) const;

  /// Whitened residual of every piece, without what its start can make.
  [[nodiscard]] std::vector<Eigen::VectorXd> residuals(const Replays& crane) const;
  /// Change of the outputs against the crane that left `at`, per unit.
  [[nodiscard]] std::vector<Eigen::VectorXd> change(const Replays& crane,
                                                    const std::vector<Eigen::VectorXd>& at,
                                                    double step) const;
  /// Of the innovations of every piece, summed.
  [[nodiscard]] std::vector<double> log_variances() const;
  /// Of every piece the window of the drives' replay that it belongs to.
  [[nodiscard]] const std::vector<std::size_t>& windows() const { return windows_; }

 private:
  void find_windows();

  const Problem& drive_;
  std::vector<Pieces> axes_;
  std::vector<std::size_t> windows_;
};

}  // namespace crane::diagnosis
