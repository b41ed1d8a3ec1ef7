#pragma once
/// Multiple shooting over one part (drive or load) of all runs: the data in windows of a few seconds, each
/// with a start of its own that is solved for and projected away.
#include <Eigen/Dense>
#include <limits>
#include <optional>
#include <vector>

#include "crane/diagnosis/replay.hpp"
#include "noise/whitening.hpp"
#include "shooting/windows.hpp"

namespace crane::diagnosis {

/// One window around one crane: everything whitened, the start's directions taken out.
struct WindowFit {
  Eigen::VectorXd start;
  Eigen::VectorXd measured_start;  ///< what the crane's sensors make of the measurement
  Eigen::VectorXd simulated;       ///< outputs one after the other, lead left out, not whitened
  Eigen::VectorXd residual;        ///< measured - simulated, whitened, projected
  /// Directions of the start, whitened: x - basis basis' x is x without what a start that is known before to
  /// some standard deviations makes, (I + A S^2 A')^(-1/2) x with A the slopes and S the deviations.
  Eigen::MatrixXd basis;
  Eigen::MatrixXd inner_slopes;      ///< whitened, of the start of terms' own coordinates
  Eigen::MatrixXd start_gain;        ///< whitened residual to change of start
  double start_log_determinant = 0;  ///< log det(I + A S^2 A')
};
using Fits = std::vector<WindowFit>;

/// Length of a window that is its run.
inline constexpr double kWholeRun = std::numeric_limits<double>::infinity();

/// A crane is handed to it as its replays on the problem's runs.
class Problem {
 public:
  /// @param window_s wanted length; runs are divided into equal parts of about that
  /// @param natural_radps of the swing
  Problem(const Runs& runs, Part part, double window_s, double natural_radps);

  [[nodiscard]] Part part() const { return part_; }
  [[nodiscard]] bool empty() const { return windows_.empty(); }
  [[nodiscard]] const std::vector<Window>& windows() const { return windows_; }
  [[nodiscard]] const std::vector<Output>& outputs() const { return outputs_; }
  [[nodiscard]] const Runs& runs() const { return runs_; }

  /// Learns noise and disturbance per output from the residuals of a crane and whitens with them from now on.
  void learn_disturbance(const Replays& crane);
  /// Noise and disturbance of what `fits` leave, by output, whatever was learnt before.
  [[nodiscard]] std::vector<Disturbance> disturbances_of(const Fits& fits) const;
  /// Whitens with these, by output, from now on.
  void whiten_with(std::vector<Disturbance> disturbances);
  [[nodiscard]] const Whitener& whitener(std::size_t output, std::size_t window) const {
    return whiteners_[output][window];
  }
  /// Of the innovation of a row of a window, rows counted output by output.
  [[nodiscard]] double log_variance(std::size_t window, std::size_t row) const {
    const std::size_t rows = windows_[window].rows;
    return whiteners_[row / rows][window].log_variance(row % rows);
  }
  [[nodiscard]] const std::vector<Disturbance>& disturbances() const { return disturbances_; }

  /// Solves for the starts from the measured ones.
  [[nodiscard]] Fits fit(const Replays& crane) const;
  /// The same from the starts of `near`: another noise, or values that differ little.
  [[nodiscard]] Fits fit_again(const Replays& crane, const Fits& near) const;
  /// Solves for the starts with the directions of `near`, a crane that differs little; as fit() where it has
  /// other coordinates.
  [[nodiscard]] Fits fit_near(const Replays& crane, const Fits& near) const;
  /// Change of the outputs against `at` per unit, whitened and projected: (outputs of crane - at) / step. The
  /// start of coordinates that only `crane` has is taken out too.
  /// @param own if given, takes the decrease of the loss that the start of such coordinates makes alone, less
  /// its price
  [[nodiscard]] std::vector<Eigen::VectorXd> change(const Replays& crane, const Fits& at, double step,
                                                    double* own = nullptr) const;
  /// The same windows with plain residuals: starts that make the error in m or rad least.
  [[nodiscard]] Problem plain() const;
  /// Rows of a window, outputs one after the other; 0 where nothing was measured, and so is what is
  /// simulated: such a row leaves nothing.
  [[nodiscard]] Eigen::VectorXd measured(const Window& window) const;
  /// What was measured of one output in a window, without the rows that were not.
  [[nodiscard]] Eigen::VectorXd seen(const Window& window, std::size_t output) const;
  /// How many rows of an output, or of all, were measured.
  [[nodiscard]] std::size_t seen_rows(const Window& window, std::size_t output) const;
  [[nodiscard]] std::size_t seen_rows(const Window& window) const;
  /// Sums of squares of measured - simulated by window, not whitened, of one output.
  [[nodiscard]] std::vector<double> squares_left(const Fits& fits, std::size_t output) const;

 private:
  /// Residuals [output][window], not whitened, of starts that were solved for with what is known.
  [[nodiscard]] std::vector<std::vector<Eigen::VectorXd>> residuals(const Fits& fits) const;
  /// Numbers of a start that every crane has.
  [[nodiscard]] Eigen::Index output_start_size() const {
    return static_cast<Eigen::Index>(2 * outputs_.size());
  }
  [[nodiscard]] Eigen::VectorXd simulate(const Replay& replay, const Window& window,
                                         const Eigen::VectorXd& start) const;
  void whiten(std::size_t window, Eigen::Ref<Eigen::MatrixXd> x) const;
  /// Whitened changes of the outputs per unit of the start's numbers from `first` on.
  [[nodiscard]] Eigen::MatrixXd start_slopes(const Replay& replay, std::size_t window,
                                             const Eigen::VectorXd& start, const Eigen::VectorXd& simulated,
                                             Eigen::Index first) const;
  [[nodiscard]] Eigen::VectorXd change_in(const Replay& replay, std::size_t window, const WindowFit& at,
                                          double step, double& own_gain) const;
  [[nodiscard]] Eigen::VectorXd measured_start(const Replay& replay, const Window& window) const;
  [[nodiscard]] Eigen::VectorXd transferred_start(const WindowFit& at, const Eigen::VectorXd& measured) const;
  /// Directions of the start. @pre simulated from it
  void linearise(const Replay& replay, std::size_t window, WindowFit& fit) const;
  /// Of the residual at the start: the start is one that was likely before, plus a change that is not seen.
  void marginalise_start(WindowFit& fit) const;
  /// @return whether the start has moved, away from where it was linearised
  bool refine_start(const Replay& replay, std::size_t window, const Eigen::VectorXd& target,
                    WindowFit& fit) const;
  void fit_start(const Replay& replay, std::size_t window, WindowFit& fit) const;
  /// A local optimum of the start, from one beginning, linearised there.
  [[nodiscard]] WindowFit fit_from(const Replay& replay, std::size_t window, const Eigen::VectorXd& target,
                                   const Eigen::VectorXd& begin) const;
  /// Whether a simulation leaves much of the motion of an output.
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
