#pragma once
/// Estimates the friction of one drive by least squares. Source: H. M. Omar, Control of Gantry and Tower
/// Cranes, Virginia Tech, 2003, section 3.1. With eta = 1 for v > d_s and xi = 1 for v < -d_s (3.3), each row
/// outside the zero-velocity band is, divided by K_m and in volts, (3.6), (3.14), corrected signs:
///   a/K_m - u = -(b+ v + c+)/K_m eta - (b- v - c-)/K_m xi
/// with a = [x(k) - 2x(k-1) + x(k-2)]/Ts^2. The two regressions differ in u and v of row k:
///   dissertation  u(k-2), v = [x(k-1) - x(k-2)]/Ts                         (3.10)-(3.14)
///   midpoint      [u(k-1) + u(k-2)]/2, v = [x(k) - x(k-2)]/(2 Ts)
/// With a constant voltage during each period, a/K_m is the mean over both periods; the midpoint form
/// therefore has no lag. In the form of the dissertation, v belongs to time k - 3/2 and u to the first
/// period; its bias is about 1 % at 100 Hz.
///
/// K_m is either given (rig file) or estimated together with the friction from u = a/K_m + .... A given K_m
/// with an error affects b/K_m and c/K_m only through a (section 3.1). An estimate of K_m needs enough
/// acceleration that is independent of v; otherwise the estimator throws.
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace crane::identification {

/// The data do not determine the result. what() states reason and remedy.
class IdentificationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Measurements of one axis with constant sampling period; element k is the value at t_k.
struct AxisRun {
  double period_s = 0.01;
  std::vector<double> position;  ///< m or rad
  std::vector<double> drive_v;   ///< V, acts from t_k to t_(k+1), minus the voltage for the force of the load
  std::vector<double> speed;     ///< true speed of a simulation, m/s or rad/s; empty: from the positions
};

enum class Regression { dissertation, midpoint };

struct FrictionOptions {
  Regression regression = Regression::midpoint;
  double zero_band = 0.1;  ///< d_s, m/s or rad/s, >= 0
  /// Cut-off / sampling frequency of the zero-phase Butterworth filter of order 5; 0: no filter.
  double cutoff_ratio = 0.1;
  bool filter_voltage = true;    ///< true: the filter applies to x and u; false: to x only
  std::optional<double> gain{};  ///< K_m, m/s^2 or rad/s^2 per V; nothing: estimated jointly
};

struct Estimate {
  double value = 0;
  double standard_error = 0;  ///< by noise of any spectrum; does not include a bias of the regression
};

/// b/K_m in V per m/s or rad/s, c/K_m in V.
struct FrictionEstimate {
  Estimate viscous_positive, viscous_negative, coulomb_positive, coulomb_negative;
  Estimate gain;                                     ///< K_m; standard error 0 when it was given
  std::size_t rows_positive = 0, rows_negative = 0;  ///< rows with v > d_s and with v < -d_s
  double residual_rms_v = 0;                         ///< root mean square of the residual, V
};

/// The standard errors come from a jackknife over 20 blocks of the run. Filtering and differentiating
/// correlate the residuals of neighbouring rows, so that the standard errors of ordinary least squares would
/// be too small. The jackknife is valid while the correlation time is short compared with a block.
/// @throws IdentificationError when a series is too short, not finite or of another length; when the axis did
///   not move outside the band, moved in one direction only or at one speed only; when u is constant; or when
///   K_m is to be estimated and the data do not determine K_m
/// @throws std::invalid_argument when the options are out of range
[[nodiscard]] FrictionEstimate estimate_friction(const AxisRun& run, const FrictionOptions& options);

/// @return contradictions to the model beyond three standard errors: negative coefficients, a negative gain;
///   empty when there are none. A typical reason is a wrong sign of voltage or position
[[nodiscard]] std::vector<std::string> contradictions(const FrictionEstimate& estimate);

}  // namespace crane::identification
