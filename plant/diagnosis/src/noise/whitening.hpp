#pragma once
/// The transform that makes a residual (disturbance.hpp) white: the innovations of its Kalman filter in units
/// of their standard deviations.
#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "noise/disturbance.hpp"

namespace crane::diagnosis {

class Whitener {
 public:
  Whitener(const Disturbance& disturbance, const WindowMotion& motion);
  /// W x with W^T W the inverse covariance of the residual, to each column of x.
  void apply(Eigen::Ref<Eigen::MatrixXd> x) const;
  /// Of the innovation of a row; 0 where nothing was measured.
  [[nodiscard]] double log_variance(std::size_t row) const {
    return rows_[row].inverse_sd > 0 ? -2 * std::log(rows_[row].inverse_sd) : 0;
  }

 private:
  struct Row {
    Eigen::Vector3d gain;
    double inverse_sd = 0;
    MotionPhase phase = MotionPhase::moving;
  };
  Eigen::Matrix3d step_;
  std::vector<Row> rows_;
};

}  // namespace crane::diagnosis
