#pragma once
/// References of the identification experiment: (4.11) for the trolley and (4.14) for the slew axis,
///   A [-0.4 sin(2 pi t/3) + 0.3 sin(2 pi t/4)],  A = 0.6 m and 2 rad,
/// with a smaller A when travel, speed or swing of the rig require it. Source: H. M. Omar, Control of Gantry
/// and Tower Cranes, Virginia Tech, 2003.
#include <optional>

#include "crane/control/excitation.hpp"

namespace crane::identification {

inline constexpr double kTrolleyAmplitude_m = 0.6;  ///< A of (4.11)
inline constexpr double kSlewAmplitude_rad = 2;     ///< A of (4.14)

/// The load on its cable, and the axis that carries it.
struct CarriedLoad {
  double cable_m = 0;          ///< L, > 0; 0: no load
  double gravity_mps2 = 9.81;  ///< g
  /// Trolley position when the axis is slew; nothing when the axis is the trolley.
  std::optional<double> radius_m;
};

/// Limits of an excitation; m or rad.
struct ExcitationLimits {
  double low = 0, high = 0;  ///< permitted travel, low < high
  double speed = 0;          ///< largest speed, m/s or rad/s, > 0
  double swing_rad = 0;      ///< largest swing, > 0 when there is a load
  CarriedLoad load;
};

/// Largest swing of an undamped load, initially at rest, when the axis follows the excitation exactly. The
/// model is a pendulum with small angles relative to the ground, r'' = -(g/L)(r - p), with r the load and p
/// its suspension point; the swing is |r - p|/L. For a slewing jib this model contains the centrifugal and
/// Coriolis terms that (2.30), (2.31) neglect.
[[nodiscard]] double predicted_swing_rad(const control::Excitation& excitation, const CarriedLoad& load);

/// The excitation (4.11), (4.14) about the middle of the travel. A is `amplitude`, or less: the sum of the
/// amplitudes of both sines stays within half the travel, the sum of their speeds within the speed limit.
/// Then A decreases in steps of 5 % until the predicted swing is within its limit.
/// @throws std::invalid_argument when an argument is out of range
[[nodiscard]] control::Excitation multi_sine(std::size_t axis, double amplitude,
                                             const ExcitationLimits& limits, double duration_s);

/// A slow sine about the middle of the travel for the break-away experiment. While the axis rests, the
/// position loop raises the voltage by `ramp_vps` until the voltage exceeds the friction; `repetitions` times
/// in each direction.
/// @param stiffness_vpu  gain of the position loop, V/m or V/rad
/// @param ramp_vps       slope of the voltage, V/s
/// @param friction_v     sum of the friction of both directions, V
/// @throws std::invalid_argument when an argument is out of range or the travel is too short
[[nodiscard]] control::Excitation break_away_sine(std::size_t axis, const ExcitationLimits& limits,
                                                  double stiffness_vpu, double ramp_vps, double friction_v,
                                                  int repetitions);

}  // namespace crane::identification
