#pragma once
/// The experiment's references: (4.11) for the trolley and (4.14) for the slew axis,
///   A [-0.4 sin(2 pi t/3) + 0.3 sin(2 pi t/4)],  A = 0.6 m and 2 rad,
/// made smaller where a rig's travel, speed or swing does not allow them.
#include <optional>

#include "crane/control/excitation.hpp"

namespace crane::identification {

inline constexpr double kTrolleyAmplitude_m = 0.6;  ///< A of (4.11)
inline constexpr double kSlewAmplitude_rad = 2;     ///< A of (4.14)

/// The load on its cable, and the axis that carries it.
struct CarriedLoad {
  double cable_m = 0;          ///< L, > 0; 0: there is no load
  double gravity_mps2 = 9.81;  ///< g
  std::optional<double>
      radius_m;  ///< of the trolley where the axis is slew; nothing: the axis is the trolley
};

/// What an excitation has to keep to; m or rad.
struct ExcitationLimits {
  double low = 0, high = 0;  ///< travel that may be used, low < high
  double speed = 0;          ///< per second, > 0
  double swing_rad = 0;      ///< swing it may cause, > 0 where there is a load
  CarriedLoad load;
};

/// Largest swing that an undamped load at rest gets from the excitation, followed exactly: over ground a
/// pendulum of small angles, r'' = -(g/L)(r - p), under its suspension p; the swing is |r - p|/L. On a
/// turning jib that has the centrifugal and Coriolis parts that (2.30), (2.31) leave out.
[[nodiscard]] double predicted_swing_rad(const control::Excitation& excitation, const CarriedLoad& load);

/// (4.11), (4.14) about the middle of the travel, `amplitude` times the largest factor <= 1 that keeps the
/// limits.
/// @throws std::invalid_argument  limits out of range
[[nodiscard]] control::Excitation multi_sine(std::size_t axis, double amplitude,
                                             const ExcitationLimits& limits, double duration_s);

/// A slow sine about the middle of the travel: with a position loop of `stiffness_vpu` volts per m or rad, it
/// raises the voltage of the resting axis by `ramp_vps`, far enough to overcome `friction_v` of both
/// directions together, `repetitions` times each way.
/// @throws std::invalid_argument  limits out of range, or the travel does not suffice
[[nodiscard]] control::Excitation break_away_sine(std::size_t axis, const ExcitationLimits& limits,
                                                  double stiffness_vpu, double ramp_vps, double friction_v,
                                                  int repetitions);

}  // namespace crane::identification
