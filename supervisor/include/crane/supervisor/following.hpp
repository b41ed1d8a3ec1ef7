#pragma once
/// Following error: does each axis move as its voltage and the equations of motion say?
///
/// From one sample to the next the speed v of a free axis changes by (2.16) to (2.20) under the voltages of
/// the last two ticks. Each parameter is only known within a tolerance, so that the model gives an interval
/// [low, high] of accelerations:
///   gain of the drive  1 +- kGainTolerance, offset +- kOffset_v
///   friction           0 to kFrictionMost times the rig file's, plus kFrictionExtra_v, against the motion
///   load               0 to kLoadMost times the rig file's
/// What the interval does not explain is summed on each side (run_length.hpp):
///   fast := max(0, fast + dv - high dt),   slow := max(0, slow + low dt - dv)
/// A sum above limit = kSpeedShare (max_speed + |v|) + noise stops the crane. noise = two counts per sample
/// interval: the quantisation of the two speeds at the ends of the sum; that of the speeds in between
/// cancels.
///
/// Detection time of a voltage error of e volts: limit / (gain (e - tolerances)) + two ticks. False alarms:
/// none while the parameters are within their tolerances; for a white disturbance of kOffset_v rms beyond
/// them the average run length is above 1e9 ticks on every rig (tests/supervisor/model_checks_test.cpp).
#include <array>

#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

struct FollowingInput {
  double sampled_s = 0;
  PerAxis position{};
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  PerAxis applied_v{};  ///< acts from this sample on
  AxisFlags free{};     ///< the brake is told to be open and reports it
};

struct FollowingMemory {
  /// One sample; the newest three are kept, newest first.
  struct Seen {
    double sampled_s = 0;
    PerAxis position{};
    double radial_rad = 0, tangential_rad = 0;
    PerAxis applied_v{};
  };
  std::array<Seen, 3> seen{};
  std::array<int, kAxes> free_ticks{};  ///< in a row
  PerAxis fast{}, slow{};               ///< sums of unexplained speed, unit/s, >= 0
  PerAxis largest{};                    ///< of sum / limit while judged: above 1 the crane is stopped
};

inline constexpr double kGainTolerance =
    0.25;                                 ///< share of the effect of a voltage: amplifier and motor constant
inline constexpr double kOffset_v = 0.3;  ///< of converter and amplifier
inline constexpr double kFrictionMost = 1.5;     ///< times the rig file's friction: temperature, dust, wear
inline constexpr double kFrictionExtra_v = 0.3;  ///< of a rig whose file says nothing about friction
inline constexpr double kLoadMost = 1.5;         ///< times the rig file's load mass
/// Speed error that is no damage yet: an axis loses it within a quarter of its soft margin, share of
/// max_speed.
inline constexpr double kSpeedShare = 0.05;

/// Sum at which an axis with this speed is stopped, unit/s. @param span_s  between two samples
[[nodiscard]] double following_limit(const Limits& limits, std::size_t axis, double speed,
                                     double span_s) noexcept;

/// One sample. @return true when an axis does not do what its drive was told; never while
/// `limits.machine.known` is
///         false
[[nodiscard]] bool following_error(const Limits& limits, const FollowingInput& input,
                                   FollowingMemory& memory) noexcept;

}  // namespace crane::supervisor
