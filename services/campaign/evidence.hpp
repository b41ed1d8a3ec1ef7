#pragma once
/// From when on a fault of a drive or an encoder can be told from a rig within its tolerances, by the truth.
/// The tolerances are those that docs/safety.md promises: gain 25 %, offset 0.3 V, friction 0 to 1.5 times
/// the rig file's and 0.3 V, load 0 to 1.5 times. What lies beyond them is an unexplained speed. A detection
/// is due 30 ms (hazard 20) after the unexplained speed has reached 10 % of max_speed, of the speed, and four
/// counts a tick: from then on a check whose own limit is half of that has had its evidence for a sample or
/// more.
#include <complex>
#include <cstddef>
#include <optional>

#include "campaign/bench.hpp"

namespace crane::campaign {

inline constexpr double kDriveDetection_ms = 30;     ///< hazard 20 of docs/safety.md
inline constexpr double kEncoderDetection_ms = 100;  ///< hazard 16 and 19

/// Sums the unexplained speed of one axis tick by tick. To be asked once a tick, after it.
class Evidence {
 public:
  Evidence(Bench& bench, std::size_t axis) : bench_{&bench}, axis_{axis} {}
  /// The drive gets other volts than the bridge has written. @return true from the visible instant on
  bool of_drive();
  /// The encoder of the axis has stood since the first call. @return the same
  bool of_standing_encoder();

 private:
  [[nodiscard]] double gain() const;
  [[nodiscard]] double tolerance_v(double applied_v, double speed) const;
  [[nodiscard]] double visible_speed(double speed) const;
  Bench* bench_;
  std::size_t axis_;
  bool started_ = false, visible_ = false;
  double fast_ = 0, slow_ = 0;
};

/// The same for a swing encoder that stands: over ground, (2.11) and (2.18), the acceleration of trolley and
/// shown load and gravity at the shown angle do not balance in the direction of the encoder. Tolerances: a
/// zero off by 20 mrad, a wind of 0.25 m/s^2, and a cable that is off by 55 %, which leaves that share of the
/// shown change of the swing rate; visible is twice 50 mm/s and two counts per four samples.
class SwingEvidence {
 public:
  SwingEvidence(Bench& bench, std::size_t counter);
  [[nodiscard]] double swing_at_first() const { return at_first_rad_; }
  bool of_standing_encoder(double shown_rad);

 private:
  /// Horizontal places over ground as complex numbers: the trolley, the load relative to it; how deep the
  /// load hangs.
  struct Place {
    std::complex<double> trolley_m, load_m;
    double depth_m;
  };
  [[nodiscard]] Place place_of(const Truth& truth, double shown_rad) const;
  Bench* bench_;
  bool radial_, visible_ = false;
  double at_first_rad_, up_ = 0, down_ = 0;
  Truth before_;
  std::optional<Truth> older_;
};

}  // namespace crane::campaign
