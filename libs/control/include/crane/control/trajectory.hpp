#pragma once
/// Rest-to-rest references: step, accelerate - coast - brake of section 3.3.1, and the same with limited jerk
/// (S-curve).
#include <array>
#include <limits>

#include "crane/control/law.hpp"

namespace crane::control {

/// Reference of one axis from rest at `start` to rest at `target`; begins at time 0. A step has no duration.
struct AxisProfile {
  double start = 0, target = 0;  ///< m or rad
  double ramp_s = 0;             ///< Delta t, length of acceleration and of braking, jerk included
  double coast_s = 0;            ///< at constant speed in between
  double speed = 0;              ///< while coasting, signed, per second
  double acceleration = 0;       ///< largest of the first ramp; the second has its negative
  double jerk_s = 0;  ///< each ramp takes so long to reach its acceleration and to leave it; 0: none

  [[nodiscard]] double duration_s() const noexcept { return 2 * ramp_s + coast_s; }
  /// Rests at `start` before time 0 and at `target` from duration_s() on. Pure, no allocation.
  [[nodiscard]] AxisReference at(double time_s) const noexcept;

 private:
  [[nodiscard]] AxisReference risen(double time_s) const noexcept;
};

/// Speed, acceleration and a finite jerk lie in [1e-9, 1e9].
struct AxisLimits {
  double speed = 0;                                       ///< V_max, per second
  double acceleration = 0;                                ///< a_max, per second squared
  double jerk = std::numeric_limits<double>::infinity();  ///< j_max, per second cubed
};

/// At `target` from time 0 on.
[[nodiscard]] AxisProfile step_profile(double start, double target) noexcept;

/// Fastest within limits: t_f = Z/V_max + V_max/a_max (3.43); a move too short for V_max is a triangle of
/// t_f = 2 sqrt(Z/a_max). A jerk limit adds a_max/j_max to t_f, or less where a_max is not reached; a move
/// that reaches neither V_max nor a_max takes t_f = 4 cbrt(Z/(2 j_max)).
/// @throws std::invalid_argument for limits outside their range, start or target outside [-1e9, 1e9]
[[nodiscard]] AxisProfile limited_profile(double start, double target, const AxisLimits& limits);

/// By final time t_f and ramp Delta t: V = Z/(t_f - Delta t), a = V/Delta t, as in (3.54), (3.55); with a
/// jerk time t_j, a = V/(Delta t - t_j) and the jerk is a/t_j.
/// @throws std::invalid_argument unless jerk_s is 0 or in [1e-9, ramp_s / 2], 1e-9 <= ramp_s <= final_time_s
/// / 2 <= 1e9, start and target in [-1e9, 1e9]
[[nodiscard]] AxisProfile timed_profile(double start, double target, double final_time_s, double ramp_s,
                                        double jerk_s = 0);

/// Same path in `duration_s`, not less than its own: speed, acceleration and jerk shrink, so limits stay
/// kept. A profile without duration stays as it is.
[[nodiscard]] AxisProfile stretched(const AxisProfile& profile, double duration_s) noexcept;

using Trajectory = std::array<AxisProfile, kAxes>;

/// All axes end when the slowest does.
[[nodiscard]] Trajectory synchronised(Trajectory trajectory) noexcept;
[[nodiscard]] double duration_s(const Trajectory& trajectory) noexcept;
[[nodiscard]] Reference reference_at(const Trajectory& trajectory, double time_s) noexcept;

}  // namespace crane::control
