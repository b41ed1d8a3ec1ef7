#pragma once
/// Maximum-likelihood estimate of a disturbance.
#include <Eigen/Dense>
#include <vector>

#include "noise/disturbance.hpp"

namespace crane::diagnosis {

/// @param residuals of windows of one output; lengths may differ
/// @param motions one for each of them
/// @param least_noise of the sensor, m or rad
/// @param near start of the search; noise 0: none
[[nodiscard]] Disturbance learn(const std::vector<Eigen::VectorXd>& residuals,
                                const std::vector<WindowMotion>& motions, double least_noise,
                                const Disturbance& near = {});

}  // namespace crane::diagnosis
