#pragma once
/// How much a whitened residual counts: like its square up to a few standard deviations, like a logarithm
/// beyond. When exactly an axis with friction breaks loose no model knows; where it does so a moment early or
/// late, the residual is as large as the slip, whatever the noise (Cauchy's weights: Holland and Welsch,
/// Comm. Statist. A6 (1977) 813).
#include <Eigen/Dense>
#include <cmath>

namespace crane::diagnosis {

/// Gauss-Newton on squares initialises a fit; the Cauchy loss, which has local minima far away, is minimised
/// then.
enum class Loss { squares, robust };

/// Standard deviations squared.
inline constexpr double kCauchyScaleSquared = 9;
/// Of a normal residual of variance 1.
inline constexpr double kMeanLoss = 0.874;

/// In noise variances.
[[nodiscard]] inline double loss_of(double e) {
  return kCauchyScaleSquared * std::log1p(e * e / kCauchyScaleSquared);
}

/// Half the slope of the loss, over e.
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
