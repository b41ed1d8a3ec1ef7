#pragma once
/// One-sided cumulative sum (CUSUM), used by the model checks of the supervisor:
///   S := max(0, S + e),  alarm when S > threshold
/// e is a change of speed minus the largest change that the model permits within its tolerances. While the
/// crane stays within these tolerances, S does not exceed the noise of two speed samples, because the noise
/// of the samples between them cancels: there is no false alarm. For an additional random disturbance,
/// average_run_length() gives the mean time to a false alarm.
#include <cmath>

namespace crane::supervisor {

/// Mean number of samples until a false alarm under an additional white Gaussian disturbance
/// (D. Siegmund, Sequential Analysis, 1985: (exp(2 d b) - 2 d b - 1) / (2 d^2), d = drift / sigma,
/// b = threshold / sigma + 1.166).
/// @param drift      margin per sample: mean of -e, > 0
/// @param sigma      standard deviation of the disturbance per sample, > 0, same unit
/// @param threshold  threshold of the sum, same unit
[[nodiscard]] inline double average_run_length(double drift, double sigma, double threshold) noexcept {
  constexpr double kOvershoot = 1.166;  // mean overshoot of a normal random walk at both boundaries, sigma
  const double d = drift / sigma, b = threshold / sigma + kOvershoot;
  return (std::exp(2 * d * b) - 2 * d * b - 1) / (2 * d * d);
}

}  // namespace crane::supervisor
