#pragma once
/// The disturbance that makes residuals likeliest.
#include <Eigen/Dense>
#include <vector>

#include "noise/disturbance.hpp"

namespace crane::diagnosis {

/// @param residuals of windows, all of one output; lengths may differ
/// @param motions one for each of them
/// @param least_noise of the sensor, m or rad
/// @param near where to begin, if something is known
[[nodiscard]] Disturbance learn(const std::vector<Eigen::VectorXd>& residuals,
                                const std::vector<WindowMotion>& motions, double least_noise,
                                const Disturbance& near = {});

}  // namespace crane::diagnosis
