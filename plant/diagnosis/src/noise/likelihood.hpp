#pragma once
/// How likely a disturbance makes the residuals of windows.
#include <Eigen/Dense>
#include <limits>
#include <vector>

#include "noise/disturbance.hpp"

namespace crane::diagnosis {

/// Minus twice the log likelihood; the disturbance has noise 1, the common scale is profiled out. The scale
/// is that whose mean loss is a normal residual's, so that slips count little.
struct Likelihood {
  double value = std::numeric_limits<double>::infinity();
  double variance = 0;
};

/// Of the innovations of the disturbance's Kalman filter (filter.hpp), after two measured rows of each window
/// that solve for its start.
/// @param near a guess of the variance; 0: none
[[nodiscard]] Likelihood likelihood(const std::vector<Eigen::VectorXd>& residuals,
                                    const std::vector<WindowMotion>& motions, const Disturbance& disturbance,
                                    double near);

}  // namespace crane::diagnosis
