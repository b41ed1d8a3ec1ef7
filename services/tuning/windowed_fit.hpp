#pragma once
/// Nonlinear least squares over windows of a run (Gauss-Newton with halved steps). The model is the replay of
/// plant/diagnosis. Each window has its own initial state (position and rate of each fitted output). The
/// fit eliminates this state: residuals and slopes are projected on the complement of the slopes with respect
/// to it.
///
/// Standard errors allow residuals of any correlation within a window: with g_w = J_w' r_w and H the sum of
/// J_w' J_w, the covariance is W/(W-p) H^-1 (sum g_w g_w') H^-1, W windows, p parameters (H. White,
/// Econometrica 48 (1980) 817, in groups).
#include <functional>
#include <string>
#include <vector>

#include "crane/diagnosis/replay.hpp"

namespace crane::tuning {

struct FitParameter {
  std::string name;
  double value = 0;
  double low = 0, high = 0;  ///< bounds of the estimate
  double step = 0;           ///< of the difference quotient
};

struct WindowedFit {
  diagnosis::Part part = diagnosis::Part::drive;
  std::vector<diagnosis::Output> outputs;  ///< compared outputs of this part
  double window_s = 2;
  double begin_s = 0;  ///< rows before this time are left out
  /// Crane for the values of the parameters.
  std::function<diagnosis::Crane(const std::vector<double>&)> crane;
  /// Output of the amplifiers by row for a command by row, V. Empty: the command.
  std::function<std::vector<plant::PerAxis>(const std::vector<double>&, const std::vector<plant::PerAxis>&)>
      amplifiers{};
};

struct FitResult {
  std::vector<double> values, standard_errors;
  double residual_rms = 0;  ///< of the compared outputs, m or rad
  std::size_t windows = 0;
};

/// @throws identification::IdentificationError when the data do not determine the parameters
[[nodiscard]] FitResult fit_windows(const std::vector<diagnosis::PreparedRun>& runs, const WindowedFit& fit,
                                    const std::vector<FitParameter>& parameters);

/// The same residual without a fit, at the values of the parameters; the initial states of the windows
/// and the parameters after the first are eliminated linearly.
[[nodiscard]] double residual_rms(const std::vector<diagnosis::PreparedRun>& runs, const WindowedFit& fit,
                                  const std::vector<FitParameter>& parameters);

}  // namespace crane::tuning
