#pragma once
/// Determines from which time on the true motion proves a fault of a drive or an encoder: no rig
/// within the tolerances of docs/safety.md can move like this. Tolerances: gain 25 %, offset 0.3 V,
/// friction 0 to 1.5 times that of the rig file plus 0.3 V, load 0 to 1.5 times. Motion beyond the
/// tolerances is an unexplained speed. The fault is visible when the unexplained speed reaches 10 %
/// of max_speed plus 10 % of the speed plus four counts per tick: twice the limit of the
/// supervisor's checks. The detection time (30 ms, hazard 20) starts then.
#include <complex>
#include <cstddef>
#include <optional>

#include "campaign/bench.hpp"

namespace crane::campaign {

inline constexpr double kDriveDetection_ms = 30;     ///< hazard 20
inline constexpr double kEncoderDetection_ms = 100;  ///< hazard 16 and 19

/// Sums the unexplained speed of one axis. Call once per tick, after the tick.
class Evidence {
 public:
  Evidence(Bench& bench, std::size_t axis) : bench_{&bench}, axis_{axis} {}
  /// For a drive whose voltage differs from the one that the bridge has written. @return true from the time
  /// at which the fault is visible
  bool of_drive();
  /// For an encoder that is frozen from the first call on. @return true from the time at which the fault is
  /// visible
  bool of_standing_encoder();

 private:
  [[nodiscard]] double gain() const;
  [[nodiscard]] double tolerance_v(double applied_v, double speed) const;
  [[nodiscard]] double visible_speed(double speed) const;
  Bench* bench_;
  std::size_t axis_;
  bool started_ = false, visible_ = false;
  double sum_above_ = 0, sum_below_ = 0;
};

/// Evidence of a frozen swing encoder, in the frame of the ground, (2.11) and (2.18) of H. M. Omar, Control
/// of Gantry and Tower Cranes: the acceleration of the load, computed from the trolley and the shown swing,
/// does not balance gravity at the shown swing angle. Only the component in the direction of the encoder
/// counts. Tolerances: zero error 20 mrad, wind 0.25 m/s^2, error of the cable length 55 %. The fault is
/// visible when the sum of the imbalance reaches twice (50 mm/s plus the noise: two counts in four samples at
/// 1.5 times the cable length).
class SwingEvidence {
 public:
  SwingEvidence(Bench& bench, std::size_t counter);
  [[nodiscard]] double swing_at_first() const { return at_first_rad_; }
  bool of_standing_encoder(double shown_rad);

 private:
  /// Horizontal positions relative to the ground, as complex numbers: trolley, and load relative to it; depth
  /// of the load.
  struct Positions {
    std::complex<double> trolley_m, load_m;
    double depth_m;
  };
  [[nodiscard]] Positions positions_of(const Truth& truth, double shown_rad) const;
  Bench* bench_;
  bool radial_, visible_ = false;
  double at_first_rad_, up_ = 0, down_ = 0;
  Truth before_;
  std::optional<Truth> older_;
};

}  // namespace crane::campaign
