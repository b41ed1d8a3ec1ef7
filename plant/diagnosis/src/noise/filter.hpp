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

/// Measurement H of the state that is measured so long after the row's time: H x = x + t x' + t^2 a / 2.
[[nodiscard]] inline Eigen::Vector3d measurement_after(double offset_s) {
  return {1, offset_s, 0.5 * offset_s * offset_s};
}

/// Covariance P of the predicted state along a window, in squares of the disturbance's units.
class PredictionCovariance {
 public:
  /// @param start_variance of x, and of the distance that x' covers in a row
  PredictionCovariance(const Disturbance& disturbance, const WindowMotion& motion, double start_variance);

  struct Update {
    Eigen::Vector3d gain;
    double variance = 0;  ///< f, of the innovation
  };
  /// Of the measurement in a row, at its own instant.
  [[nodiscard]] Update update(std::size_t row) const;
  [[nodiscard]] MotionPhase phase(std::size_t row) const {
    return sticks_ ? motion_.profile[row].phase : MotionPhase::moving;
  }
  void advance(std::size_t row);

 private:
  /// Of x, x', a.
  struct Symmetric {
    double xx = 0, xv = 0, xa = 0, vv = 0, va = 0, aa = 0;
  };
  /// F p F'.
  [[nodiscard]] Symmetric propagated(const Symmetric& p) const;

  const WindowMotion& motion_;
  bool sticks_ = false, steady_ = false;
  Eigen::Matrix3d step_;
  Symmetric p_;
  double noise_variance_ = 0, process_noise_ = 0, friction_ = 0, unknown_speed_ = 0;
};

}  // namespace crane::diagnosis
