#pragma once
/// Following error: does each axis do what its drive was told, and does it stay near its reference?
///
/// Model: from one tick to the next the speed of a free axis changes by what the equations of motion make of
/// the voltages of the last two ticks, (2.16) to (2.20), within what is not known of it: kGainUnknown of the
/// voltage's effect, kOffset_v, any friction from none to 1.5 times the rig file's, and as much again as the
/// load does. What lies beyond is added up, forgotten with kForget_s, and compared with
/// kSpeedShare (max_speed + |v|). Bound: an encoder that stops shows its whole speed in one tick; a dead
/// drive at a V shows gain V (1 - kGainUnknown) a second. Reference: position - reference, against
/// kTravelShare of the travel, kReferenceLag_s of the reference's speed, what is left of the last step of the
/// reference, and what a swinging load moves the axis by.
#include <array>

#include "crane/plant/parameters.hpp"
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

/// false = healthy
struct Following {
  bool once = false;   ///< beyond the limit
  bool twice = false;  ///< beyond twice the limit
};

struct FollowingInput {
  double sampled_s = 0;
  PerAxis position{};
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  PerAxis applied_v{};  ///< acts from this sample on
  AxisFlags free{};     ///< the brake is told to be open and reports it
  bool reference_arrived = false;
  PerAxis reference{}, reference_speed{};
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
  PerAxis speed_error{};                ///< unexplained change of speed, unit/s
  PerAxis last_reference{};
  PerAxis step_left{};   ///< what is left of the last step of the reference, unit
  double swing_rad = 0;  ///< amplitude of the last seconds
  bool referenced = false;
  PerAxis largest{};  ///< of both errors over their limits while judged: 1 stops the crane
};

inline constexpr double kGainUnknown = 0.25;  ///< share of the effect of a voltage
inline constexpr double kOffset_v = 0.3;
inline constexpr double kForget_s = 0.15;
inline constexpr double kSpeedShare = 0.05;
inline constexpr double kTravelShare = 0.1;
inline constexpr double kReferenceLag_s = 0.5;

/// One sample. Nothing is judged while `limits.machine.known` is false.
[[nodiscard]] Following judge_following(const Limits& limits, const FollowingInput& input,
                                        FollowingMemory& memory) noexcept;

}  // namespace crane::supervisor
