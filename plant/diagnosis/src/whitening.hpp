#pragma once
/// What sensor noise and an unknown coloured force do to the residual of a window, and the transform that
/// makes that white. The residual of one output over n rows has the covariance
///   S = s_n^2 I + s_d^2 H R(rho) H^T
/// with R the correlation of a first-order coloured acceleration and H the response of the output to it: a
/// drive with viscous friction, or a pendulum for a swing. Directions that the free start of a window
/// explains are left out. The numbers are found by maximum likelihood from the residuals themselves.
#include <Eigen/Dense>
#include <map>
#include <vector>

namespace crane::diagnosis {

/// m or rad: no encoder is finer, and an axis that stands still leaves nothing at all.
inline constexpr double kLeastNoise = 1e-7;

struct Disturbance {
  double noise = 0;          ///< s_n, m or rad
  double acceleration = 0;   ///< s_d, m/s2 or rad/s2
  double correlation_s = 0;  ///< correlation time of the acceleration
  double damping_ps = 0;     ///< of the drive, 1/s
};

class Whitener {
 public:
  /// @param natural_radps of a pendulum; 0: a drive
  /// @param residuals of windows, all of one output; lengths may differ
  Whitener(const std::vector<Eigen::VectorXd>& residuals, double period_s, double natural_radps);
  /// Makes the transform for windows of `rows` rows. apply() needs it.
  void prepare(Eigen::Index rows);
  /// W x with W^T W = S^-1, to the rows of x.
  void apply(Eigen::Ref<Eigen::MatrixXd> x) const;
  [[nodiscard]] const Disturbance& disturbance() const { return disturbance_; }

 private:
  [[nodiscard]] const Eigen::MatrixXd& factor(Eigen::Index rows) const;
  double period_s_, natural_radps_;
  Disturbance disturbance_;
  std::map<Eigen::Index, Eigen::MatrixXd> factors_;  ///< lower Cholesky factor of S by length
};

}  // namespace crane::diagnosis
