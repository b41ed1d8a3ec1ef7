#pragma once
/// Motion of a drive at one instant, on which its friction depends.
#include "crane/plant/smooth_sign.hpp"

namespace crane::plant {

class DriveMotion {
 public:
  DriveMotion(double position_, double speed_) noexcept : position(position_), speed(speed_) {}

  const double position;  ///< m or rad
  const double speed;     ///< m/s or rad/s

  /// Smooth sign of the speed. The dry friction of an axis usually has one width for all terms, and tanh
  /// costs more than the rest of a term: the last result is kept. @param smoothing_speed  v_s > 0 [m/s or
  /// rad/s]
  [[nodiscard]] double smooth_sign(double smoothing_speed) const noexcept {
    if (smoothing_speed != smoothing_speed_) {
      smoothing_speed_ = smoothing_speed;
      sign_ = plant::smooth_sign(speed, smoothing_speed);
    }
    return sign_;
  }

 private:
  mutable double smoothing_speed_ = 0, sign_ = 0;
};

}  // namespace crane::plant
