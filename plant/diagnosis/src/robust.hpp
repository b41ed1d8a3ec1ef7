#pragma once
/// Cauchy loss of a whitened residual: nearly quadratic below three standard deviations, logarithmic beyond
/// (P. W. Holland, R. E. Welsch, Comm. Statist. A6 (1977) 813). A slip that the model predicts one row early
/// leaves a residual of the size of the slip, for any noise.
#include <Eigen/Dense>
#include <cmath>

namespace crane::diagnosis {

/// A fit first minimises the sum of squares and then the Cauchy loss, which has local minima.
enum class Loss { squares, robust };

/// Noise variances.
inline constexpr double kCauchyScaleSquared = 9;
/// Mean loss of a standard normal residual.
inline constexpr double kMeanLoss = 0.874;
/// Mean of e^2 W(e) of a standard normal residual e. At the true scale, the mean of loss / kLossPerDeviance
/// decreases by 1 per unit of ln(variance): its sum with ln(variance) is stationary.
inline constexpr double kLossPerDeviance = 0.776;
/// Of standard normal residuals: curvature of half the loss, E[(e W(e))'] = E[e^2 W(e)] (C. M. Stein, Ann.
/// Statist. 9 (1981) 1135), over the mean weight E[W(e)] = 1 - E[e^2 W(e)] / 9.
inline constexpr double kCurvaturePerWeight = kLossPerDeviance / (1 - kLossPerDeviance / kCauchyScaleSquared);
/// Of standard normal residuals: variance of the score, E[(e W(e))^2] = 0.620, over the curvature.
inline constexpr double kScorePerCurvature = 0.620 / kLossPerDeviance;

/// In noise variances.
[[nodiscard]] inline double loss_of(double e) {
  return kCauchyScaleSquared * std::log1p(e * e / kCauchyScaleSquared);
}

/// Weight W: half the slope of the loss, over e.
[[nodiscard]] inline double weight_of(double e) { return 1 / (1 + e * e / kCauchyScaleSquared); }

[[nodiscard]] inline double loss_of(const Eigen::VectorXd& residual) {
  double sum = 0;
  for (const double e : residual) sum += loss_of(e);
  return sum;
}

[[nodiscard]] inline Eigen::VectorXd weights_of(const Eigen::VectorXd& residual, Loss loss = Loss::robust) {
  if (loss == Loss::squares) return Eigen::VectorXd::Ones(residual.size());
  return residual.unaryExpr([](double e) { return weight_of(e); });
}

}  // namespace crane::diagnosis
