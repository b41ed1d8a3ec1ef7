#pragma once
/// Fit of a hypothesis to one simulated run of an experiment, in whitened windows.
#include <Eigen/Dense>
#include <vector>

#include "experiment/next_experiment.hpp"
#include "noise/whitening.hpp"
#include "study/hypothesis.hpp"

namespace crane::diagnosis {

/// Every kWindowStride-th window is compared: enough to rank motions.
inline constexpr std::size_t kWindowStride = 2;

/// The crane with further terms.
[[nodiscard]] Crane with(Crane crane, const Effects& effects);

/// Whitened misfit of a crane to one run in one part. Starts of windows are projected out along the
/// directions of the first crane.
class WindowMisfit {
 public:
  /// @param run  outlives this object
  WindowMisfit(const PreparedRun& run, Part part, double gravity_mps2, const Disturbances& disturbances);

  /// One column per output: windows one after the other.
  [[nodiscard]] Eigen::MatrixXd misfit(const Crane& crane);

 private:
  [[nodiscard]] std::size_t windows() const;
  [[nodiscard]] std::size_t first_of(std::size_t window) const { return window * kWindowStride * rows_; }
  void whiten(std::size_t window, Eigen::Ref<Eigen::MatrixXd> x) const;
  /// Rows after the lead.
  [[nodiscard]] Eigen::VectorXd kept_of(const std::vector<double>& values) const;
  [[nodiscard]] Eigen::VectorXd simulate(const Replay& replay, std::size_t window,
                                         const std::vector<double>& start) const;
  [[nodiscard]] Eigen::VectorXd measured(std::size_t window) const;
  /// Orthonormal directions of the start.
  [[nodiscard]] Eigen::MatrixXd start_directions(const Replay& replay, std::size_t window,
                                                 const std::vector<double>& start,
                                                 const Eigen::VectorXd& at) const;

  const PreparedRun& run_;
  Part part_;
  std::vector<Output> outputs_;
  std::vector<Whitener> whiteners_;  ///< by output, then window
  std::size_t rows_ = 0, lead_ = 0;
  std::vector<Eigen::MatrixXd> bases_;
};

/// Refits a hypothesis to one run, in the parts that its causes act on.
class Refit {
 public:
  /// @param run  outlives this object
  Refit(const Crane& base, const PreparedRun& run, const Disturbances& disturbances,
        const std::vector<const Candidate*>& causes);

  /// Misfit of each part.
  [[nodiscard]] std::vector<Eigen::MatrixXd> misfits(const Effects& effects);

  /// Gauss-Newton with step halving, inside the bounds. The base model, without effects, has no values to
  /// fit.
  void fit(Effects& effects);

 private:
  [[nodiscard]] Eigen::VectorXd step(const Effects& at, const Eigen::VectorXd& residual);

  Crane base_;
  std::vector<WindowMisfit> parts_;
};

}  // namespace crane::diagnosis
