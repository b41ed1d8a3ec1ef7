#pragma once
/// Rest-to-rest references: step, and accelerate - coast - brake of section 3.3.1.
#include <array>

#include "crane/control/law.hpp"

namespace crane::control {

/// Reference of one axis from rest at `start` to rest at `target`; begins at time 0. A step has no duration.
struct AxisProfile {
  double start = 0, target = 0;  ///< m or rad
  double ramp_s = 0;             ///< Delta t, length of acceleration and of braking
  double coast_s = 0;            ///< at constant speed in between
  double speed = 0;              ///< while coasting, signed, per second
  double acceleration = 0;       ///< first ramp; the second has its negative

  [[nodiscard]] double duration_s() const noexcept { return 2 * ramp_s + coast_s; }
  /// Rests at `start` before time 0 and at `target` from duration_s() on. Pure, no allocation.
  [[nodiscard]] AxisReference at(double time_s) const noexcept;
};

struct AxisLimits {
  double speed = 0;         ///< V_max, per second, > 0
  double acceleration = 0;  ///< a_max, per second squared, > 0
};

/// At `target` from time 0 on.
[[nodiscard]] AxisProfile step_profile(double start, double target) noexcept;

/// Fastest within limits: t_f = Z/V_max + V_max/a_max (3.43); a move too short for V_max is a triangle of
/// t_f = 2 sqrt(Z/a_max). @throws std::invalid_argument for limits that are not positive or input not finite
[[nodiscard]] AxisProfile limited_profile(double start, double target, const AxisLimits& limits);

/// By final time t_f and ramp Delta t: V = Z/(t_f - Delta t), a = V/Delta t, as in (3.54), (3.55).
/// @throws std::invalid_argument unless 0 < ramp_s <= final_time_s / 2, all finite
[[nodiscard]] AxisProfile timed_profile(double start, double target, double final_time_s, double ramp_s);

/// Same path in `duration_s`, not less than its own: speed and acceleration shrink, so limits stay kept.
/// A profile without duration stays as it is.
[[nodiscard]] AxisProfile stretched(const AxisProfile& profile, double duration_s) noexcept;

using Trajectory = std::array<AxisProfile, kAxes>;

/// All axes end when the slowest does.
[[nodiscard]] Trajectory synchronised(Trajectory trajectory) noexcept;
[[nodiscard]] double duration_s(const Trajectory& trajectory) noexcept;
[[nodiscard]] Reference reference_at(const Trajectory& trajectory, double time_s) noexcept;

}  // namespace crane::control
