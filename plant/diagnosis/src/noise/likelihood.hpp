#pragma once
/// Likelihood of a disturbance, given residuals.
#include <Eigen/Dense>
#include <limits>
#include <vector>

#include "noise/disturbance.hpp"

namespace crane::diagnosis {

/// Minus twice the log likelihood of a disturbance, without constant.
struct Likelihood {
  double value = std::numeric_limits<double>::infinity();
  double variance = 0;  ///< common factor of all variances
};

/// Likelihood of the innovations of the Kalman filter (filter.hpp), the common scale profiled out. The first
/// two measured rows of a window determine its start and are not counted. The scale is robust: the mean
/// Cauchy loss is that of normal residuals.
/// @param disturbance  with noise 1
/// @param best another likelihood of the same residuals; its variance is the initial value of the scale
/// @return without a value if it would not be smaller than that of `best`
[[nodiscard]] Likelihood likelihood(const std::vector<Eigen::VectorXd>& residuals,
                                    const std::vector<WindowMotion>& motions, const Disturbance& disturbance,
                                    const Likelihood& best);

/// Minus twice the log likelihood of a disturbance with noise 1 and with this common factor of all variances.
[[nodiscard]] double value_at(double variance, const std::vector<Eigen::VectorXd>& residuals,
                              const std::vector<WindowMotion>& motions, const Disturbance& disturbance);

}  // namespace crane::diagnosis
