#pragma once
/// Rest-to-rest references: step, bang-coast-bang, and bang-coast-bang with limited jerk (S-curve).
/// Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, section 3.3.1.
#include <array>
#include <limits>

#include "crane/control/law.hpp"

namespace crane::control {

/// Reference of one axis from rest at `start` to rest at `target`. It begins at time 0. A step has duration
/// 0.
struct AxisProfile {
  double start = 0, target = 0;  ///< m or rad
  double ramp_s = 0;        ///< Delta t, duration of the acceleration phase and of the deceleration phase
  double coast_s = 0;       ///< duration of the phase of constant speed
  double speed = 0;         ///< speed of this phase, signed, m/s or rad/s
  double acceleration = 0;  ///< largest acceleration of the first ramp, signed, m/s^2 or rad/s^2
  double jerk_s = 0;        ///< duration of constant jerk at either end of each ramp; 0: unlimited jerk

  [[nodiscard]] double duration_s() const noexcept { return 2 * ramp_s + coast_s; }
  /// Reference at `time_s`: at rest at `start` before time 0, at rest at `target` from duration_s() on. No
  /// allocation.
  [[nodiscard]] AxisReference at(double time_s) const noexcept;

 private:
  [[nodiscard]] AxisReference first_half(double time_s) const noexcept;
};

/// Speed, acceleration and a finite jerk must be in [1e-9, 1e9].
struct AxisLimits {
  double speed = 0;                                       ///< V_max, m/s or rad/s
  double acceleration = 0;                                ///< a_max, m/s^2 or rad/s^2
  double jerk = std::numeric_limits<double>::infinity();  ///< j_max, m/s^3 or rad/s^3
};

/// Reference that is at `target` from time 0 on.
[[nodiscard]] AxisProfile step_profile(double start, double target) noexcept;

/// Fastest profile within the limits. With Z = |target - start|:
///   t_f = Z/V_max + V_max/a_max                  (3.43)
///   t_f = 2 sqrt(Z/a_max)                        when the move is too short to reach V_max
/// A jerk limit adds a_max/j_max to t_f, or less when the move does not reach a_max:
///   t_f = 4 cbrt(Z/(2 j_max))                    when the move reaches neither V_max nor a_max
/// @throws std::invalid_argument for limits outside their range, start or target outside [-1e9, 1e9]
[[nodiscard]] AxisProfile limited_profile(double start, double target, const AxisLimits& limits);

/// Profile with final time t_f and ramp Delta t: V = Z/(t_f - Delta t), a = V/Delta t, as in (3.54), (3.55).
/// With a jerk time t_j, a = V/(Delta t - t_j) and the jerk is a/t_j.
/// @throws std::invalid_argument unless jerk_s is 0 or in [1e-9, ramp_s / 2], 1e-9 <= ramp_s <= final_time_s
///   / 2 <= 1e9, start and target in [-1e9, 1e9]
[[nodiscard]] AxisProfile timed_profile(double start, double target, double final_time_s, double ramp_s,
                                        double jerk_s = 0);

/// The same path with a longer duration. Speed, acceleration and jerk decrease, so that all limits still
/// hold. A profile with duration 0 does not change. @pre duration_s >= profile.duration_s()
[[nodiscard]] AxisProfile stretched(const AxisProfile& profile, double duration_s) noexcept;

using Trajectory = std::array<AxisProfile, kAxes>;

/// Stretches all profiles to the duration of the longest one.
[[nodiscard]] Trajectory synchronised(Trajectory trajectory) noexcept;
[[nodiscard]] double duration_s(const Trajectory& trajectory) noexcept;
[[nodiscard]] Reference reference_at(const Trajectory& trajectory, double time_s) noexcept;

}  // namespace crane::control
