#pragma once
/// The kinds of motion of the trajectory planner. at() gives the reference at a path time in s, which
/// duration_s() ends.
#include <array>
#include <cstdint>
#include <optional>

#include "crane/control/excitation.hpp"
#include "crane/control/law.hpp"
#include "crane/control/route.hpp"
#include "crane/control/shaper.hpp"
#include "crane/control/stick.hpp"
#include "crane/control/time_optimal.hpp"
#include "crane/control/trajectory.hpp"

namespace crane::services {

/// Profiles from rest to rest, shaped for trolley and slew: the hoist causes no swing. An excitation replaces
/// the profile of its axis.
struct Profiles {
  control::Trajectory trajectory{};
  control::Shaper shaper;
  std::optional<control::Excitation> excitation;
  [[nodiscard]] control::Reference at(double time_s) const noexcept;
  [[nodiscard]] double duration_s() const noexcept;
};
/// A path around zones; the shaper acts on trolley and slew.
struct AroundZones {
  control::Route route;
  control::Shaper shaper;
  [[nodiscard]] control::Reference at(double time_s) const noexcept;
  [[nodiscard]] double duration_s() const noexcept { return route.duration_s() + shaper.delay_s(); }
};
/// A time-optimal plan of the crane `design`.
struct Planned {
  const control::Design* design;
  control::PlanProblem problem;
  control::Plan plan;
  [[nodiscard]] control::Reference at(double time_s) const noexcept;
  [[nodiscard]] double duration_s() const noexcept { return plan.duration_s; }
};
/// The last reference of drive(): it has no duration and does not depend on the path time.
struct Stick {
  control::StickLimits limits;
  control::StickMemory memory;
  control::Reference reference;
  std::uint64_t tick = 0;  ///< tick of `reference`
  [[nodiscard]] control::Reference at(double /*time_s*/) const noexcept { return reference; }
  [[nodiscard]] double duration_s() const noexcept { return 0; }
};
/// Homing: constant speeds without end.
struct Creeping {
  std::array<double, control::kAxes> speed{}, start{};
  [[nodiscard]] control::Reference at(double time_s) const noexcept;
  [[nodiscard]] double duration_s() const noexcept;
};
/// A controlled stop: constant deceleration of each axis from `speed` to rest.
struct Braking {
  struct Axis {
    double start = 0, speed = 0, deceleration = 1;
    [[nodiscard]] double duration_s() const noexcept;
    [[nodiscard]] control::AxisReference at(double time_s) const noexcept;
  };
  std::array<Axis, control::kAxes> axis{};
  [[nodiscard]] control::Reference at(double time_s) const noexcept;
  [[nodiscard]] double duration_s() const noexcept;
};

}  // namespace crane::services
