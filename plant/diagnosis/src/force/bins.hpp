#pragma once
/// Triangular bins: a function of one variable that is linear between the centres of its bins.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace crane::diagnosis {

/// Weights of the bins. @param share  place in the range of the variable; outside [0, 1]: the nearest end
[[nodiscard]] inline Eigen::RowVectorXd triangular_bins(double share, std::size_t bins) {
  const double at = static_cast<double>(bins - 1) * std::clamp(share, 0.0, 1.0);
  Eigen::RowVectorXd weights(static_cast<Eigen::Index>(bins));
  for (Eigen::Index bin = 0; bin < weights.size(); ++bin)
    weights[bin] = std::max(0.0, 1 - std::abs(at - static_cast<double>(bin)));
  return weights;
}

}  // namespace crane::diagnosis
