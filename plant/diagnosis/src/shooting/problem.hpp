#pragma once
/// Multiple shooting over one part (drive or load) of all runs (H. G. Bock 1983): windows of a few seconds.
/// The start of each window is estimated and marginalised (docs/diagnosis_method.md, 3 to 5) with the prior
/// standard deviations S.
#include <Eigen/Dense>
#include <limits>
#include <optional>
#include <vector>

#include "crane/diagnosis/replay.hpp"
#include "noise/whitening.hpp"
#include "shooting/windows.hpp"

namespace crane::diagnosis {

/// One window of one crane. A = d(whitened output) / d(start).
struct WindowFit {
  Eigen::VectorXd start;
  Eigen::VectorXd measured_start;  ///< measured, the crane's sensor terms inverted
  Eigen::VectorXd simulated;       ///< outputs one after the other, without the lead, not whitened
  Eigen::VectorXd residual;        ///< (I + A S^2 A')^(-1/2) times the whitened measured - simulated
  /// I - basis basis' = (I + A S^2 A')^(-1/2).
  Eigen::MatrixXd basis;
  Eigen::MatrixXd inner_slopes;      ///< columns of A of inner coordinates
  Eigen::MatrixXd start_gain;        ///< whitened residual to Gauss-Newton step of the start
  double start_log_determinant = 0;  ///< log det(I + A S^2 A')
};
using Fits = std::vector<WindowFit>;

/// Window length: a whole run is one window.
inline constexpr double kWholeRun = std::numeric_limits<double>::infinity();

/// A crane is passed as its replays on the problem's runs. Immutable.
class Problem {
 public:
  /// @param window_s approximate length: runs are divided into equal parts
  /// @param natural_radps of the swing
  Problem(const Runs& runs, Part part, double window_s, double natural_radps);

  [[nodiscard]] Part part() const { return part_; }
  [[nodiscard]] bool empty() const { return windows_.empty(); }
  [[nodiscard]] const std::vector<Window>& windows() const { return windows_; }
  [[nodiscard]] const std::vector<Output>& outputs() const { return outputs_; }
  [[nodiscard]] const Runs& runs() const { return runs_; }

  /// The same problem, whitened with the disturbances of the residuals of a crane.
  [[nodiscard]] Problem whitened_by(const Replays& crane) const;
  /// Disturbances of the residuals of `fits`, by output. @param near disturbances of similar residuals, with
  /// which the search begins; empty: none are known
  [[nodiscard]] std::vector<Disturbance> disturbances_of(const Fits& fits,
                                                         const std::vector<Disturbance>& near = {}) const;
  /// The same problem, whitened with these disturbances. Without one disturbance for each output, the problem
  /// is empty: no start of a window was determined, and nothing is compared.
  [[nodiscard]] Problem whitened_with(std::vector<Disturbance> disturbances) const;
  [[nodiscard]] const Whitener& whitener(std::size_t output, std::size_t window) const {
    return whiteners_[output][window];
  }
  [[nodiscard]] const WindowMotion& motion(std::size_t output, std::size_t window) const {
    return motions_[output][window];
  }
  /// ln f of a row of a window; rows are counted output by output.
  [[nodiscard]] double log_variance(std::size_t window, std::size_t row) const {
    const std::size_t rows = windows_[window].rows;
    return whiteners_[row / rows][window].log_variance(row % rows);
  }
  [[nodiscard]] const std::vector<Disturbance>& disturbances() const { return disturbances_; }

  /// Estimates the starts. The iteration begins at the measured starts.
  [[nodiscard]] Fits fit(const Replays& crane) const;
  /// Like fit(), but the iteration begins at the starts of `near`: a fit with other noise or similar
  /// parameters.
  [[nodiscard]] Fits fit_again(const Replays& crane, const Fits& near) const;
  /// Like fit_again(), but reuses the slopes with respect to the starts in `near`, the fits of a similar
  /// crane. If that crane has other coordinates, like fit().
  [[nodiscard]] Fits fit_near(const Replays& crane, const Fits& near) const;
  /// Slopes: (outputs of crane - at) / step, whitened, start marginal; also the start of coordinates that
  /// only `crane` has.
  /// @param own receives the decrease of the loss by the start of these coordinates without any other change
  [[nodiscard]] std::vector<Eigen::VectorXd> change(const Replays& crane, const Fits& at, double step,
                                                    double* own = nullptr) const;
  /// Slopes that do not depend on the noise: (outputs of crane - at) / step, from the same starts.
  /// @pre `crane` has the coordinates of `at`
  [[nodiscard]] std::vector<Eigen::VectorXd> plain_change(const Replays& crane, const Fits& at,
                                                          double step) const;
  /// Whether the crane has other freely oscillating inner coordinates than the crane of `fits`.
  [[nodiscard]] bool has_other_coordinates(const Replays& crane, const Fits& fits) const;
  /// Whitens plain slopes, start marginal. Slopes that are empty stay empty.
  [[nodiscard]] std::vector<std::vector<Eigen::VectorXd>> whitened(
      const std::vector<std::vector<Eigen::VectorXd>>& plain_slopes, const Fits& at) const;
  /// The same problem without whitening: its starts minimise the error in m or rad.
  [[nodiscard]] Problem plain() const;
  /// Measured rows of a window, outputs one after the other. Rows without a measurement are 0, in the
  /// simulation too: their residual is 0.
  [[nodiscard]] Eigen::VectorXd measured(const Window& window) const;
  /// Measured values of one output in a window, without missing rows.
  [[nodiscard]] Eigen::VectorXd measured_values(const Window& window, std::size_t output) const;
  /// Number of measured rows of an output, or of all.
  [[nodiscard]] std::size_t measured_rows(const Window& window, std::size_t output) const;
  [[nodiscard]] std::size_t measured_rows(const Window& window) const;
  /// Sum of squares of measured - simulated [m2 or rad2] by window, of one output.
  [[nodiscard]] std::vector<double> squares_left(const Fits& fits, std::size_t output) const;
  /// Sums of squares of the change of the simulation from `at` to another crane with the same starts [m2 or
  /// rad2], by window and output.
  [[nodiscard]] std::vector<std::vector<double>> squares_changed(const Replays& crane, const Fits& at) const;

 private:
  void set_disturbances(std::vector<Disturbance> disturbances);
  /// Residuals [output][window], not whitened, at the starts of `fits`.
  [[nodiscard]] std::vector<std::vector<Eigen::VectorXd>> residuals(const Fits& fits) const;
  /// Size of the start without inner coordinates.
  [[nodiscard]] Eigen::Index output_start_size() const {
    return static_cast<Eigen::Index>(2 * outputs_.size());
  }
  [[nodiscard]] Eigen::VectorXd simulate(const Replay& replay, const Window& window,
                                         const Eigen::VectorXd& start) const;
  void whiten(std::size_t window, Eigen::Ref<Eigen::MatrixXd> x) const;
  /// Columns of A from `first` on, by finite differences.
  [[nodiscard]] Eigen::MatrixXd start_slopes(const Replay& replay, std::size_t window,
                                             const Eigen::VectorXd& start, const Eigen::VectorXd& simulated,
                                             Eigen::Index first) const;
  /// Start of another crane that corresponds to the start of `at`.
  [[nodiscard]] Eigen::VectorXd start_near(const Replay& replay, std::size_t window,
                                           const WindowFit& at) const;
  [[nodiscard]] Eigen::VectorXd change_in(const Replay& replay, std::size_t window, const WindowFit& at,
                                          double step, double& own_gain) const;
  [[nodiscard]] Eigen::VectorXd measured_start(const Replay& replay, const Window& window) const;
  [[nodiscard]] Eigen::VectorXd transferred_start(const WindowFit& at, const Eigen::VectorXd& measured) const;
  /// Sets A's decomposition at the start. @pre simulated from it
  void linearise(const Replay& replay, std::size_t window, WindowFit& fit) const;
  /// Multiplies the residual by (I + A S^2 A')^(-1/2), after inner coordinates return to their measured
  /// start.
  void marginalise_start(WindowFit& fit) const;
  /// @return whether the start has moved
  bool refine_start(const Replay& replay, std::size_t window, const Eigen::VectorXd& target,
                    WindowFit& fit) const;
  void fit_start(const Replay& replay, std::size_t window, WindowFit& fit) const;
  /// Fit of a window from the end of the fit before it.
  [[nodiscard]] WindowFit continued_from(const Replay& replay, std::size_t window, const Fits& fits) const;
  void continue_ringing(const Replays& crane, Fits& fits) const;
  /// Local optimum of the start from one beginning, linearised there.
  [[nodiscard]] WindowFit fit_from(const Replay& replay, std::size_t window, const Eigen::VectorXd& target,
                                   const Eigen::VectorXd& begin) const;
  /// Whether the residual exceeds kPoorlyFollowed of the motion of an output.
  [[nodiscard]] bool poorly_followed(std::size_t window, const Eigen::VectorXd& target,
                                     const Eigen::VectorXd& simulated) const;

  const Runs& runs_;
  Part part_;
  std::vector<Output> outputs_;
  std::vector<Window> windows_;
  std::vector<std::vector<WindowMotion>> motions_;  ///< by output and window
  std::vector<Disturbance> disturbances_;           ///< by output; empty: plain residuals
  std::vector<std::vector<Whitener>> whiteners_;    ///< by output and window
};

}  // namespace crane::diagnosis
