#pragma once
/// Micro-speed, inching and return to the stop point: pure functions from keys and positions to deflections
/// and targets. MICROSPEED and INCHING are functions of a crane axis in OPC 40020-1, table 18: large
/// movements of the stick become slow motion of the load; the load moves in small increments.
#include <array>
#include <cstddef>

namespace crane::cli {

/// Share of the largest speed in micro-speed. The standard states no value. A tenth lets the trolley of the
/// rig files (0.5 m/s) creep with 5 cm/s; judgement.
inline constexpr double kMicroSpeed = 0.1;

/// Step of inching in m: a fifth of the band (10 mm) in which the planner regards a move as finished;
/// judgement.
inline constexpr double kInchingStep_m = 0.002;
/// Range of the step in m. A step below the resolution of the encoders does not move; a longer one is a move.
inline constexpr double kSmallestStep_m = 0.0005, kLargestStep_m = 0.05;

/// One press of a key.
struct InchingStep {
  std::size_t axis = 0;  ///< 0 trolley, 1 slew, 2 hoist
  int direction = 1;     ///< 1 or -1
  bool operator==(const InchingStep&) const = default;
};

/// Targets of a move.
struct AxisTargets {
  std::array<bool, 3> selected{};
  std::array<double, 3> target{};  ///< m, rad, m of cable
};

/// Target one step from the present reference. The steps of the reference add up exactly; from the measured
/// position, the static error of the axis would shorten or lengthen every step.
/// @param reference  m, rad, m of cable
/// @param step_m     travel of the trolley, of the cable, or of the trolley on its arc: step_m / radius
[[nodiscard]] AxisTargets inched(const std::array<double, 3>& reference, const InchingStep& step,
                                 double step_m);

/// Angle of an arc of `step_m` at this trolley position. Radii below 0.1 m count as 0.1 m.
[[nodiscard]] double arc_rad(double step_m, double trolley_position_m);

/// Target of the return to `point`. An axis takes part when the stick drove it, or when it has moved by more
/// than 1 mm or 1 mrad: slewing also moves the trolley (docs/jog.md).
[[nodiscard]] AxisTargets back_to(const std::array<double, 3>& point, const std::array<double, 3>& now,
                                  const std::array<bool, 3>& driven);

}  // namespace crane::cli
