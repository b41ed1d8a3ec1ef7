#pragma once
/// The reference of the trajectory planner, without the bus: the active motion and its start tick.
#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "crane/configuration/rig.hpp"
#include "crane/control/law.hpp"
#include "crane/control/shaper.hpp"
#include "crane/control/stick.hpp"
#include "crane/control/time_optimal.hpp"
#include "crane/control/trajectory.hpp"
#include "trajectory_planner/motion_kinds.hpp"
#include "trajectory_planner/profile_limits.hpp"

namespace crane::services {

class Motion {
 public:
  /// @param rig  limits of the reference per drive; must outlive the motion
  Motion(const configuration::Rig& rig, control::ReferenceShape shape);

  /// Sets the reference to the measured position, while the crane is not under control.
  void follow(const control::Measurement& measured, std::uint64_t tick) noexcept;
  /// Begins a move at `tick` from the present reference. @pre reference_rests(tick), as for all functions
  /// that begin a motion from the present reference: a motion that begins at speed would pass the limits
  void start(const MoveTarget& move, std::uint64_t tick);
  /// Begins to follow a path at `tick`.
  /// @param path  around zones, from the present reference
  void start(const control::Path& path, const control::PathSpace& space, std::uint64_t tick);
  /// Slows the reference down to rest along its path, which is free of zones and inside the limits. Has no
  /// effect on a reference that rests, is slowing down, or follows a stick, which rests after its release.
  /// @return tick at which the reference rests
  std::uint64_t slow_down(std::uint64_t tick) noexcept;
  /// True when the reference is at rest.
  [[nodiscard]] bool reference_rests(std::uint64_t tick) const noexcept;
  /// True when the reference is at rest, and every axis is at rest within 0.02 m or 0.02 rad of it.
  [[nodiscard]] bool rests(const control::Measurement& measured, std::uint64_t tick) const noexcept;
  /// Planning problem of a time-optimal move from the present reference. Nothing when the move needs no plan:
  /// the controller uses none, the cable moves, or the reference is not at rest.
  [[nodiscard]] std::optional<control::PlanProblem> plan_for(const MoveTarget& move,
                                                             std::uint64_t tick) const noexcept;
  /// Begins a planned move at `tick`.
  void start(const control::PlanProblem& problem, const control::Plan& plan, std::uint64_t tick) noexcept;
  /// Excites one axis from `tick` on. The references of the other axes do not change.
  void excite(const control::Excitation& excitation, std::uint64_t tick);
  /// Decelerates from the measured speed with the reference acceleration until rest.
  void stop(const control::Measurement& measured, std::uint64_t tick) noexcept;
  /// Moves with constant speeds (m/s, rad/s, m/s of cable); 0: rest. A new speed starts at the measured
  /// position, so that an axis that has detected a mark stops there, without a tracking error.
  void follow_homing_speed(const std::array<double, control::kAxes>& speed,
                           const control::Measurement& measured, std::uint64_t tick) noexcept;
  /// Begins to follow a stick with the selected axes from the present reference. While the slew axis follows,
  /// the trolley compensates the slewing, even if it is not selected.
  void jog(const std::array<bool, control::kAxes>& selected, std::uint64_t tick) noexcept;
  /// Updates the reference at `tick` from the deflection of the stick. @pre jog() is active
  /// @param deflection  in [-1, 1], share of the largest speed of the session
  void drive(const std::array<double, control::kAxes>& deflection, std::uint64_t tick) noexcept;
  /// Reference at `tick`; while following a stick, the reference of the last drive().
  [[nodiscard]] control::Reference at(std::uint64_t tick) const noexcept;
  /// Whether every axis is within 10 mm or 10 mrad of the reference.
  [[nodiscard]] bool is_near(const control::Measurement& measured, std::uint64_t tick) const noexcept;
  /// Tick at which the motion began.
  [[nodiscard]] std::uint64_t start_tick() const noexcept { return start_tick_; }
  /// True when the reference has ended and the crane is at rest near it; at the latest 20 s after the end of
  /// the reference.
  [[nodiscard]] bool arrived(const control::Measurement& measured, std::uint64_t tick) const noexcept;

 private:
  [[nodiscard]] control::AxisProfile planned(std::size_t axis, double start, double target,
                                             const ProfileLimits& profile) const;
  /// Cable length within the range of the rig file: > 0 also without a load, where the measured length is 0.
  [[nodiscard]] double usable_cable_m(double cable_m) const noexcept;
  [[nodiscard]] control::Shaper shaper(control::Shaping shaping, double cable_m) const;
  /// Style of the path that the controller can follow with `shaper`.
  [[nodiscard]] control::RouteStyle route_style(const control::Shaper& shaper) const noexcept;
  /// Path time, s: time since the start of the reference; slower while slow_down() is active.
  [[nodiscard]] double time_s(std::uint64_t tick) const noexcept;
  /// Derivative of the path time with respect to time, in [0, 1].
  [[nodiscard]] double rate(std::uint64_t tick) const noexcept;
  /// Reference at the path time of `tick`, with speeds and accelerations per path time.
  [[nodiscard]] control::Reference on_path(std::uint64_t tick) const noexcept;
  void begin_at(std::uint64_t tick) noexcept;

  const configuration::Rig& rig_;
  control::ReferenceShape shape_;
  control::Shaping shaping_;  ///< shaping of the controller, else of the rig file
  std::variant<Profiles, AroundZones, Planned, Stick, Creeping, Braking> active_;
  /// Slows the path time from begin_s on to a standstill after duration_s.
  struct Slowing {
    double begin_s = 0, duration_s = 1;
  };
  std::optional<Slowing> slowing_;
  std::uint64_t start_tick_ = 0;
};

}  // namespace crane::services
