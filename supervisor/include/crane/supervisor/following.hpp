#pragma once
/// Following error: compares the motion of each axis with the equations of motion under its voltage.
///
/// From one sample to the next, the speed v of a free axis changes by (2.16) to (2.20) of H. M. Omar, Control
/// of Gantry and Tower Cranes, under the voltages of the last two ticks. Each parameter is known only within
/// a tolerance. The model therefore gives an interval [low, high] of accelerations:
///   gain of the drive  1 +- kGainTolerance, offset +- kOffset_v
///   friction           0 to kFrictionRatioMax times that of the rig file plus kFrictionExtra_v, against the
///                      motion
///   load mass          0 to kLoadRatioMax times that of the rig file
/// Two sums add the changes of speed outside the interval (run_length.hpp):
///   above := max(0, above + dv - high dt),   below := max(0, below + low dt - dv)
/// A sum above limit = kSpeedShare (max_speed + |v|) + noise stops the crane. noise = two counts per sample
/// interval: the quantisation of the first and of the last speed of the sum. The quantisation of the other
/// speeds cancels.
///
/// Detection time of a voltage error of e volts: limit / (gain (e - tolerances)) + two ticks. False alarms:
/// none while the parameters are within their tolerances; for a white disturbance of kOffset_v rms beyond
/// them the average run length is above 1e9 ticks on every rig (tests/supervisor/model_checks_test.cpp).
#include <array>

#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

struct FollowingInput {
  double sampled_s = 0;  ///< s, clock of the bridge
  PerAxis position{};    ///< unit
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  PerAxis applied_v{};  ///< V, acts from this sample on
  AxisFlags free{};     ///< true: the brake is commanded open and reports open
};

struct FollowingMemory {
  /// One sample of the last three, newest first.
  struct PastSample {
    double sampled_s = 0;
    PerAxis position{};
    double radial_rad = 0, tangential_rad = 0;
    PerAxis applied_v{};
  };
  std::array<PastSample, 3> recent{};
  std::array<int, kAxes> free_ticks{};  ///< consecutive samples with an open brake, at most 5
  PerAxis above{}, below{};  ///< sums of the change of speed above and below the interval, unit/s, >= 0
  PerAxis largest{};         ///< largest sum / limit so far; above 1 stops the crane
};

inline constexpr double kGainTolerance = 0.25;  ///< relative error of amplifier gain and motor constant
inline constexpr double kOffset_v = 0.3;        ///< offset of converter and amplifier
/// largest friction / friction of the rig file: temperature, dust, wear
inline constexpr double kFrictionRatioMax = 1.5;
inline constexpr double kFrictionExtra_v = 0.3;  ///< friction of a rig whose file gives none
inline constexpr double kLoadRatioMax = 1.5;     ///< largest load mass / load mass of the rig file
/// Permitted speed error / max_speed. From this speed, an axis stops within a quarter of its soft margin.
inline constexpr double kSpeedShare = 0.05;

/// Limit of the sums of an axis at this speed, unit/s. @param span_s  time between two samples
[[nodiscard]] double following_limit(const Limits& limits, std::size_t axis, double speed,
                                     double span_s) noexcept;

/// Processes one sample. @return true when a sum exceeds its limit; never while `limits.machine.known` is
/// false
[[nodiscard]] bool following_error(const Limits& limits, const FollowingInput& input,
                                   FollowingMemory& memory) noexcept;

}  // namespace crane::supervisor
