#pragma once
/// Are the swing encoders alive? The load is a pendulum under a point whose way is measured: over ground
///   r'' = -(g cos(alpha) + L alpha'^2) (r - p) / L                                   (2.11), (2.18), (2.19)
/// with r the load, p the trolley above it, both horizontal, and alpha the angle of the cable. No
/// acceleration of an axis has to be known. An observer with kObserver_radps follows the load that the
/// encoders show; what it has to correct is the residual. A swing encoder has failed when
///   frozen: its counts stand for kFrozen_ticks while the residual exceeds kFrozen_rad and 5 % of the swing,
///   erratic: its rate changes from sample to sample by more than twice what gravity and the drives can do,
///   three times in a row
///            or nearly so,
///   implausible: the residual exceeds kImplausible_rad, 10 % of the swing and kRate_s of its rate.
/// A cable 5 % longer than measured, 0.25 m/s2 of wind or a zero wrong by 20 mrad leave a residual below 11
/// mrad.
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

inline constexpr double kObserver_radps = 4;
inline constexpr int kFrozen_ticks = 8;
inline constexpr double kFrozen_rad = 0.015;
inline constexpr double kImplausible_rad = 0.06;
inline constexpr double kRate_s = 0.1;

struct PendulumInput {
  double sampled_s = 0;
  PerAxis position{};
  double radial_rad = 0, tangential_rad = 0;
};

struct PendulumMemory {
  bool started = false;
  double sampled_s = 0;
  std::array<double, 2> load_m{}, load_mps{};           ///< over ground, horizontal: the observer
  std::array<double, 2> pivot_m{};                      ///< at the sample before
  std::array<double, 2> swing_rad{};                    ///< radial, tangential; newest
  std::array<double, 2> shown_radps{}, smooth_radps{};  ///< its last rate, and the smoothed one
  std::array<double, 2> frozen_at_rad{};
  std::array<int, 2> frozen_ticks{};
  std::array<double, 2> erratic{};
  double largest = 0;  ///< of every criterion over its limit: 1 is a failure
};

/// One sample. @return true when a swing encoder has failed; never while `limits.machine.known` is false
[[nodiscard]] bool swing_sensor_failed(const Limits& limits, const PendulumInput& input,
                                       PendulumMemory& memory) noexcept;

}  // namespace crane::supervisor
