#pragma once
/// A hypothesis: its effects, its nuisance parameters, and its fit to the training data.
#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
#include "shooting/problem.hpp"

namespace crane::diagnosis {

/// A candidate of a hypothesis, with its values. docs/diagnosis_method.md calls an accepted one a cause.
struct Effect {
  const Candidate* candidate = nullptr;
  std::vector<double> values;
};
using Effects = std::vector<Effect>;

/// Losses of consecutive blocks of about `kBlock_s`, the units of resampling. The blocks of the drives, which
/// include the equation error, precede the blocks of the load.
using Blocks = std::vector<double>;
inline constexpr double kBlock_s = 2.0;
[[nodiscard]] double sum(const Blocks& blocks);

/// Residuals of one crane over a set of runs.
struct Evaluation {
  Fits drive, load;
  std::vector<Eigen::VectorXd>
      equation_error;  ///< whitened residuals of the drives along the measured motion
  Blocks blocks;
  std::size_t drive_blocks = 0;  ///< number of blocks of the drives
  double drive_loss = std::numeric_limits<double>::infinity(), load_loss = drive_loss, loss = drive_loss;
};

/// Nuisance parameters of a hypothesis: noise and disturbance by output (of the drives, of the drives along
/// the measured motion, of the load), and errors of the rig file within its accuracy (inaccuracies.hpp).
struct Nuisance {
  std::vector<Disturbance> drive, equation_error, load;
  Effects inaccuracies;
};

struct Fitted {
  Effects effects;
  Evaluation train;
  Nuisance nuisance;        ///< in which `train` is evaluated and whitened
  Nuisance first_nuisance;  ///< learnt from the residuals of its first fit
  double misfit = 0;        ///< minus twice the log likelihood of the first fit, with free starts of windows
  /// Minus twice the log likelihood of the training data by block, with the penalty of the fitted values.
  Blocks deviance;
  double penalty = 0;  ///< penalty of the fitted values; contained in `deviance`
  Blocks left_out;     ///< by block: increase of its deviance when the fit omits this block (Takeuchi)
  /// Mean over the windows of the rms error of the simulation in a window, m or rad.
  std::array<double, kOutputs> error{};
  /// The same over whole runs, for swings only: a drive integrates any error of friction into its position.
  std::array<double, kOutputs> whole_error{};
  /// By effect and output: rms difference, in windows, between the simulations with and without the effect,
  /// from the same starts, m or rad.
  std::vector<std::array<double, kOutputs>> change;
  /// Standard deviations of all values in the order of `effects`, by the block scores alone. The search
  /// compares hypotheses with them.
  std::vector<double> block_std_dev;
  /// The same, combined with the other errors and scaled to a 95 % interval of +-1.96. The verdict tests and
  /// reports them. Empty before with_intervals().
  std::vector<double> interval_std_dev;
  std::size_t parameters = 0;
};

/// Parts of the data in which an effect is visible.
struct ShowsIn {
  bool drive = false, load = false;
};

/// Parts in which any of the effects is visible.
[[nodiscard]] ShowsIn shown_in(const Effects& effects);

/// True for one effect whose candidate is rough. Several effects need no pattern search: their fit begins at
/// the values that each of them has alone.
[[nodiscard]] bool needs_pattern_search(const Effects& effects);

/// Adds `step` to the values and clamps them to their bounds.
[[nodiscard]] Effects moved(Effects effects, const Eigen::VectorXd& step);

}  // namespace crane::diagnosis
