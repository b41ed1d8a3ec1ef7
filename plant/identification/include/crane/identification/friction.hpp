#pragma once
/// Friction of one drive by least squares, section 3.1. With eta = 1 for v > d_s, xi = 1 for v < -d_s (3.3),
/// the rows outside the band are, all over K_m and in volts (3.6), (3.14), corrected signs:
///   a/K_m - u = -(b+ v + c+)/K_m eta - (b- v - c-)/K_m xi
/// Regressions differ in what stands for a, v and u of row k, a = [x(k) - 2x(k-1) + x(k-2)]/Ts^2:
///   dissertation  u(k-2), v = [x(k-1) - x(k-2)]/Ts                         (3.10)-(3.14)
///   midpoint      [u(k-1) + u(k-2)]/2, v = [x(k) - x(k-2)]/(2 Ts)
/// For volts held over each period a/K_m is the mean of both periods, so the midpoint form has no lag. In the
/// dissertation's, v belongs to k - 3/2 and u to the first period alone: it is biased by about 1 % at 100 Hz.
///
/// K_m. Friction alone does not tell it: a slow or steady motion has a = 0, and every K_m explains it. It can
/// be given (from the rig file; an error of K_m then enters b/K_m, c/K_m only through a, section 3.1), or it
/// is estimated jointly from u = a/K_m + ... where the reference accelerates enough, independently of v.
/// Where it does not, estimating it is refused.
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace crane::identification {

/// These data cannot answer; what() says why, and what to do.
class IdentificationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One axis at equal times; row k is t_k. m or rad.
struct AxisRun {
  double period_s = 0.01;
  std::vector<double> position;
  std::vector<double> drive_v;  ///< V acting from t_k to t_(k+1), less those that the load takes
  std::vector<double>
      speed;  ///< where a simulation knows it; empty: from positions, as each regression has it
};

enum class Regression { dissertation, midpoint };

struct FrictionOptions {
  Regression regression = Regression::midpoint;
  double zero_band = 0.1;        ///< d_s, m/s or rad/s, >= 0
  double cutoff_ratio = 0.1;     ///< of the zero-phase Butterworth filter of order 5; 0: unfiltered
  bool filter_voltage = true;    ///< the filter acts on u as on x; false: on x alone
  std::optional<double> gain{};  ///< K_m, m/s^2 or rad/s^2 per V; nothing: estimated jointly
};

struct Estimate {
  double value = 0;
  double standard_error = 0;  ///< of noise, however coloured; says nothing about a bias of the regression
};

/// b/K_m in V per m/s or rad/s, c/K_m in V.
struct FrictionEstimate {
  Estimate viscous_positive, viscous_negative, coulomb_positive, coulomb_negative;
  Estimate gain;  ///< K_m; standard error 0 where it was given
  std::size_t rows_positive = 0, rows_negative = 0;
  double residual_rms_v = 0;
};

/// Standard errors by a jackknife over twentieths of the run: residuals of filtered and differentiated data
/// are correlated over neighbouring rows, which ordinary least squares would take for new information. They
/// hold as long as the correlation is short against a twentieth of the run.
/// @throws IdentificationError  a series is too short, not finite or of another length; the axis did not move
///   outside the band, moved in one direction only, or at one speed only; u is constant; K_m is to be
///   estimated and the data do not tell it
/// @throws std::invalid_argument  options out of range
[[nodiscard]] FrictionEstimate estimate_friction(const AxisRun& run, const FrictionOptions& options);

/// What contradicts the model beyond three standard errors: a negative coefficient, a negative gain. Empty:
/// nothing. A wrong sign of voltage or position shows here.
[[nodiscard]] std::vector<std::string> contradictions(const FrictionEstimate& estimate);

}  // namespace crane::identification
