#pragma once
/// Whitening filter of a residual (disturbance.hpp): innovations of its Kalman filter over their standard
/// deviations.
#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "noise/disturbance.hpp"

namespace crane::diagnosis {

class Whitener {
 public:
  Whitener(const Disturbance& disturbance, const WindowMotion& motion);
  /// x = W x, column by column; W^T W is the inverse covariance of the residual.
  void apply(Eigen::Ref<Eigen::MatrixXd> x) const;
  /// ln f of a row; 0 if the row was not measured.
  [[nodiscard]] double log_variance(std::size_t row) const {
    return rows_[row].inverse_sd > 0 ? -2 * std::log(rows_[row].inverse_sd) : 0;
  }

 private:
  template <int kColumns>
  void apply_to(Eigen::Ref<Eigen::MatrixXd> x, Eigen::Index first) const;

  struct Row {
    Eigen::Vector3d gain;
    double inverse_sd = 0;
    MotionPhase phase = MotionPhase::moving;
  };
  Eigen::Matrix3d step_;
  std::vector<Row> rows_;
};

}  // namespace crane::diagnosis
