#pragma once
/// Kalman filter of a residual (disturbance.hpp): state x, x', a (R. E. Kalman, J. Basic Eng. 82 (1960) 35).
/// The gains do not depend on the residual.
#include <Eigen/Dense>

#include "noise/disturbance.hpp"

namespace crane::diagnosis {

/// Transition F of the state from row to row.
[[nodiscard]] Eigen::Matrix3d transition_of(const Disturbance& disturbance, const WindowMotion& motion);

/// The state at the next row.
[[nodiscard]] inline Eigen::Vector3d next_state(const Eigen::Matrix3d& step, Eigen::Vector3d state,
                                                MotionPhase phase) {
  if (phase != MotionPhase::moving) state[1] = 0;
  return step * state;
}

/// Covariance P of the predicted state along a window, in squares of the disturbance's units.
class PredictionCovariance {
 public:
  /// @param start_variance of x, and of the distance that x' covers in a row
  PredictionCovariance(const Disturbance& disturbance, const WindowMotion& motion, double start_variance);

  /// Variance f of the innovation.
  [[nodiscard]] double variance() const { return variance_; }
  [[nodiscard]] const Eigen::Vector3d& gain() const { return gain_; }
  [[nodiscard]] MotionPhase phase(std::size_t row) const {
    return sticks_ ? motion_.profile[row].phase : MotionPhase::moving;
  }
  void advance(std::size_t row);

 private:
  /// Symmetric matrix over x, x' (v) and a.
  struct Symmetric {
    double xx = 0, xv = 0, xa = 0, vv = 0, va = 0, aa = 0;
  };
  /// Sets P with the variance and gain that follow from it.
  void become(const Symmetric& p);
  /// F p F'.
  [[nodiscard]] Symmetric propagated(const Symmetric& p) const;

  const WindowMotion& motion_;
  bool sticks_ = false, steady_ = false;
  Eigen::Matrix3d step_;
  Symmetric p_;
  double variance_ = 0;
  Eigen::Vector3d gain_;
  double noise_variance_ = 0, process_noise_ = 0, friction_ = 0, unknown_speed_ = 0, unit_ = 1;
};

}  // namespace crane::diagnosis
