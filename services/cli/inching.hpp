#pragma once
/// Constants of micro-speed and inching, and targets of inching and of the return to the stop point.
/// OPC 40020-1, table 18, defines two functions of a crane axis. MICROSPEED: a large movement of the stick
/// causes a slow motion of the load. INCHING: the load moves in small increments.
#include <array>
#include <cstddef>

namespace crane::cli {

/// Factor of the deflection in micro-speed. The standard states no value. With 0.1, a trolley whose stick
/// commands up to 0.5 m/s moves with at most 0.05 m/s. The value is chosen, not derived.
inline constexpr double kMicroSpeed = 0.1;

/// Step of inching in m: a fifth of the band (10 mm) in which the planner regards a move as finished. The
/// value is chosen, not derived.
inline constexpr double kInchingStep_m = 0.002;
/// Range of the step in m. A step below the resolution of the encoders causes no motion. Use `crane move` for
/// longer steps.
inline constexpr double kSmallestStep_m = 0.0005, kLargestStep_m = 0.05;

/// One step of inching: axis and direction.
struct InchingStep {
  std::size_t axis = 0;  ///< 0 trolley, 1 slew, 2 hoist
  int direction = 1;     ///< 1 or -1
  bool operator==(const InchingStep&) const = default;
};

/// Selected axes and targets of a move.
struct AxisTargets {
  std::array<bool, 3> selected{};
  std::array<double, 3> target{};  ///< m, rad, m of cable
};

/// Target of a step: the present reference plus the step. Steps from the reference add up exactly; from the
/// measured position, the static position error of the axis would change every step.
/// @param reference  present reference: m, rad, m of cable
/// @param step_m     travel of the trolley or of the cable; for the slew axis, arc of the trolley (arc_rad())
[[nodiscard]] AxisTargets inched(const std::array<double, 3>& reference, const InchingStep& step,
                                 double step_m);

/// Angle of an arc of `step_m` with the trolley position as its radius. A radius below 0.1 m counts as 0.1 m.
[[nodiscard]] double arc_rad(double step_m, double trolley_position_m);

/// Target of the return to `point`. An axis is selected when the stick drove it, or when its position differs
/// from `point` by more than 1 mm or 1 mrad: a session that drives the slew axis also moves the trolley
/// (docs/jog.md).
/// @param point, now  m, rad, m of cable
[[nodiscard]] AxisTargets back_to(const std::array<double, 3>& point, const std::array<double, 3>& now,
                                  const std::array<bool, 3>& driven);

}  // namespace crane::cli
