#pragma once
/// Nonlinear least squares over windows of a run (Gauss-Newton with step halving). The model is the replay of
/// plant/diagnosis. Each window has its own initial state (position and rate of each fitted output), which
/// the fit eliminates by variable projection: it projects residuals and Jacobian on the orthogonal complement
/// of the Jacobian with respect to the initial state.
///
/// Standard errors are cluster-robust: residuals of one window may be correlated. With g_w = J_w' r_w and H
/// the sum of J_w' J_w, the covariance is W/(W-p) H^-1 (sum g_w g_w') H^-1 for W windows and p parameters (H.
/// White, Econometrica 48 (1980) 817, with windows as clusters).
#include <functional>
#include <string>
#include <vector>

#include "crane/diagnosis/replay.hpp"

namespace crane::tuning {

struct FitParameter {
  std::string name;
  double value = 0;
  double low = 0, high = 0;  ///< bounds of the estimate
  double step = 0;           ///< step of the difference quotient
};

struct WindowedFit {
  diagnosis::Part part = diagnosis::Part::drive;
  std::vector<diagnosis::Output> outputs;  ///< compared outputs of this part
  double window_s = 2;
  double begin_s = 0;  ///< rows before this time are not used
  /// Returns the crane for values of the parameters.
  std::function<diagnosis::Crane(const std::vector<double>&)> crane;
  /// Returns the output voltages of the amplifiers for commanded voltages, one entry per row.
  /// Empty: the output voltages are the commanded voltages.
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

/// FitResult::residual_rms without iterations: at the values of the parameters, eliminates the initial states
/// of the windows and all parameters except the first by one linear step.
[[nodiscard]] double residual_rms(const std::vector<diagnosis::PreparedRun>& runs, const WindowedFit& fit,
                                  const std::vector<FitParameter>& parameters);

}  // namespace crane::tuning
