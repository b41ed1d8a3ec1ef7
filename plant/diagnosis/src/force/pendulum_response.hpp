#pragma once
/// Swing of a pendulum at rest under a prescribed acceleration.
#include <Eigen/Dense>
#include <cmath>

namespace crane::diagnosis {

/// Replaces accelerations [rad/s2] of a pendulum by its swing from rest [rad], column by column. Each row
/// lasts one period of the data.
inline void replace_by_pendulum_response(Eigen::MatrixXd& x, double natural_radps, double period_s) {
  const double c = std::cos(natural_radps * period_s), s = std::sin(natural_radps * period_s);
  Eigen::RowVectorXd angle = Eigen::RowVectorXd::Zero(x.cols()), rate = angle;
  for (Eigen::Index k = 0; k < x.rows(); ++k) {
    const Eigen::RowVectorXd equilibrium = x.row(k) / (natural_radps * natural_radps);
    x.row(k) = angle;
    const Eigen::RowVectorXd from_equilibrium = angle - equilibrium;
    angle = equilibrium + c * from_equilibrium + s / natural_radps * rate;
    rate = c * rate - natural_radps * s * from_equilibrium;
  }
}

}  // namespace crane::diagnosis
