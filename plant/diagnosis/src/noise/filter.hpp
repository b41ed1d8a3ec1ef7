#pragma once
/// Kalman filter of a residual (disturbance.hpp): state position, speed and acceleration of the force
/// (Kalman, J. Basic Eng. 82 (1960) 35). Its gains do not depend on the residual.
#include <Eigen/Dense>

#include "noise/disturbance.hpp"

namespace crane::diagnosis {

/// From row to row: position and speed of the residual, the force's acceleration.
[[nodiscard]] Eigen::Matrix3d transition_of(const Disturbance& disturbance, const WindowMotion& motion);

/// The state at the next row.
[[nodiscard]] inline Eigen::Vector3d next_state(const Eigen::Matrix3d& step, Eigen::Vector3d state,
                                                MotionPhase phase) {
  if (phase != MotionPhase::moving) state[1] = 0;
  return step * state;
}

/// Covariance of the filter's prediction along a window, in the square of the disturbance's units.
class PredictionCovariance {
 public:
  /// @param start_variance of position, and of the way that the speed makes in a row
  PredictionCovariance(const Disturbance& disturbance, const WindowMotion& motion, double start_variance);

  /// Of the next residual, noise included.
  [[nodiscard]] double variance() const { return p_.xx + noise_variance_; }
  [[nodiscard]] Eigen::Vector3d gain() const { return Eigen::Vector3d{p_.xx, p_.xv, p_.xa} / variance(); }
  [[nodiscard]] MotionPhase phase(std::size_t row) const {
    return sticks_ ? motion_.profile[row].phase : MotionPhase::moving;
  }
  void advance(std::size_t row);

 private:
  /// Of position, speed and acceleration.
  struct Symmetric {
    double xx = 0, xv = 0, xa = 0, vv = 0, va = 0, aa = 0;
  };
  /// F p F' with F the step from row to row.
  [[nodiscard]] Symmetric propagated(const Symmetric& p) const;

  const WindowMotion& motion_;
  bool sticks_ = false, steady_ = false;
  Eigen::Matrix3d step_;
  Symmetric p_;
  double noise_variance_ = 0, process_noise_ = 0, friction_ = 0, unknown_speed_ = 0;
};

}  // namespace crane::diagnosis
