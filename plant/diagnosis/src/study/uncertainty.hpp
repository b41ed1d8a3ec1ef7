#pragma once
/// Uncertainty of the values of a fit, marginal over the inaccuracies of the rig file.
#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// Uncertainty of one value.
struct ValueUncertainty {
  /// Standard deviation by the sandwich covariance of all values and inaccuracies, from the jackknife over
  /// blocks with the covariances of neighbouring blocks.
  double std_dev = 0;
  double freedom = 1;  ///< degrees of freedom of the jackknife
  /// Standard deviation over that of independent blocks, at least 1.
  double by_correlation = 1;
  double by_noise = 0;  ///< standard deviation by the learnt noise and disturbance alone
  /// Standard deviation by the errors of the zeros of the swing sensors, and by the inaccuracies at their
  /// bounds.
  double systematic = 0;
  /// Changes of all values and inaccuracies along which the others minimise the loss, per unit of this value.
  Eigen::VectorXd line;
  double bend = 0;  ///< increase of the loss along the line by the bounds of the inaccuracies, per unit^2
};

struct Uncertainty {
  Effects effects;  ///< of the fit, then the inaccuracies that are visible in the same parts of the data
  std::vector<ValueUncertainty> values;  ///< of the effects of the fit
};

/// @param data in the noise of the fit
[[nodiscard]] Uncertainty uncertainty_of(const WhitenedData& data, const Fitted& fitted);

}  // namespace crane::diagnosis
