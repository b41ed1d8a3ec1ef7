#pragma once
/// One-sided cumulative sum, the test that the model checks of the supervisor use:
///   S := max(0, S + e),  alarm when S > threshold
/// e is the part of a change of speed that the model does not explain within its tolerances, minus the
/// tolerance. While the model holds within its tolerances, S stays below the noise of two speeds, because the
/// noise of all samples in between cancels: there is no false alarm. The average run length says what a
/// disturbance outside the model may be.
#include <cmath>

namespace crane::supervisor {

/// Average number of samples until a false alarm, when a white Gaussian disturbance comes on top of the model
/// (D. Siegmund, Sequential Analysis, 1985: (exp(2 d b) - 2 d b - 1) / (2 d^2), d = drift / sigma,
/// b = threshold / sigma + 1.166).
/// @param drift      margin per sample: mean of -e, > 0
/// @param sigma      standard deviation of the disturbance per sample, > 0, same unit
/// @param threshold  of the sum, same unit
[[nodiscard]] inline double average_run_length(double drift, double sigma, double threshold) noexcept {
  constexpr double kOvershoot = 1.166;  // mean excess of a normal random walk over both boundaries, in sigma
  const double d = drift / sigma, b = threshold / sigma + kOvershoot;
  return (std::exp(2 * d * b) - 2 * d * b - 1) / (2 * d * d);
}

}  // namespace crane::supervisor
