#pragma once
/// Stick mode: an operator drives trolley, slew and hoist by speed, and the load follows without swing.
///
/// 1. The unshaped speed u of each axis follows the wanted speed. A change d of u acts through an input
/// shaper
///    (shaper.hpp): the share w_i acts t_i later,
///      v(t) = sum_i w_i u(t - t_i),   zv: w = 1/2, 1/2; t = 0, T/2   (Singer and Seering 1990)
///    The shares are positive and their sum is 1, so that v stays between the smallest and the largest u. A
///    change is limited such that no share raises |dv/dt| above the acceleration limit in any tick. T is the
///    swing period of the longest cable of the session, rounded up to an even number of ticks. The hoist
///    causes no swing and is not shaped.
/// 2. Each shaped coordinate s drives a load coordinate q (radius or angle of the load),
///      q'' = w^2 (s - q),   w = 2 pi / T
///    which comes to rest together with s, whatever the history of the stick.
/// 3. The suspension point follows from the motion of the load: with the load at y = q_r e^(i q_gamma),
///      P = y + L / (g - L'') y''
///    This is the equation of a load with a small swing angle in the inertial frame, so that slewing
///    (Coriolis and centrifugal force) and hoisting are included. |P| and arg(P) are the references of
///    trolley and slew. While the jib slews, the trolley moves inwards, about L/g gamma'^2 of its radius, and
///    the load stays on its circle. At constant length and without slewing, P = s.
///
/// Position limits: each tick simulates the stop that a release in this tick causes, with everything that is
/// still pending. A wanted speed whose stop leaves the limits is replaced by braking.
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "crane/control/law.hpp"
#include "crane/control/shaper.hpp"

namespace crane::control {

/// Longest delay of a shaper in ticks.
inline constexpr std::size_t kStickSlots = 4096;

/// One axis; "unit" is m (trolley, hoist) or rad (slew).
struct StickAxisLimits {
  double speed = 0;               ///< largest |v|, unit/s; 0: the axis does not move
  double acceleration = 0;        ///< largest |dv/dt|, unit/s^2; > 0 when speed > 0
  double low = -1e9, high = 1e9;  ///< s stays inside, unit
};

struct StickLimits {
  std::array<StickAxisLimits, kAxes> axis{};
  Shaping shaping = Shaping::zv;  ///< none: P = s, and no planned swing
  double period_s = 0.01;         ///< tick, > 0
  double gravity_mps2 = 9.81;     ///< > 0
  double longest_cable_m = 100;   ///< longest cable of the session, > 0
};

/// Changes of speed that act in this and in later ticks. A copy costs the pending ticks only.
class PendingChanges {
 public:
  PendingChanges() = default;
  PendingChanges(const PendingChanges& other) noexcept { *this = other; }
  PendingChanges& operator=(const PendingChanges& other) noexcept;
  /// Change in `ticks` ticks; 0: this tick.
  [[nodiscard]] double in(std::size_t ticks) const noexcept {
    return ticks < count_ ? slot_[(first_ + ticks) % kStickSlots] : 0;
  }
  /// @pre ticks < kStickSlots
  void add(std::size_t ticks, double change) noexcept;
  /// Removes and returns the change of this tick.
  double take() noexcept;
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }

 private:
  std::array<double, kStickSlots> slot_;  // only the `count_` values from `first_` on are valid
  std::size_t first_ = 0, count_ = 0;
};

/// Positions that a motion reaches.
struct Reach {
  double low = 0, high = 0;
};

struct StickAxis {
  double position = 0, speed = 0, acceleration = 0;  ///< s; the acceleration is that of the last tick
  double unshaped = 0;                               ///< u, unit/s
  double lag = 0;       ///< distance by which the pending changes shorten the way, unit
  Reach release{0, 0};  ///< positions of the stop after a release now
  PendingChanges pending;
  double behind = 0, behind_rate = 0;  ///< q - s and its derivative; 0 for the hoist
};

/// Shares of a change in whole ticks.
struct TickShares {
  struct Share {
    std::size_t ticks = 0;
    double weight = 1;
  };
  std::array<Share, 3> share{};
  std::size_t count = 1;
  double mean_s = 0;    ///< mean delay
  double heaviest = 1;  ///< largest weight
};

/// Suspension point and swing at one tick.
struct StickPoint {
  std::array<double, kAxes> position{};
  double radial_rad = 0, tangential_rad = 0;
};

struct StickMemory {
  std::array<StickAxis, kAxes> axis{};
  std::array<StickAxisLimits, kAxes> limits{};  ///< of s and u
  TickShares shares;                            ///< of trolley and slew
  double frequency_radps = 0;                   ///< w
  std::array<StickPoint, 4> path{};             ///< newest first
  int rest_ticks = 0;                           ///< ticks since s is at rest, at most the length of the path
};

/// @return all problems as "name = value: rule"; empty when the stick can be used
[[nodiscard]] std::vector<std::string> problems(const StickLimits& limits);

/// Begins at `reference`. Its speed is the first unshaped speed; positions outside the limits are allowed,
/// and can only be left inwards. @pre problems(limits).empty()
void begin(const StickLimits& limits, const Reference& reference, StickMemory& memory) noexcept;

/// One tick. No allocation.
/// @param wanted  speed per axis, unit/s; beyond the speed limit it is limited, NaN counts as 0
/// @return reference two ticks before the newest point of the path, with the swing of the tick after it (when
///   the command of its tick acts); `start` and `feed_forward_v` are 0
Reference step(const StickLimits& limits, const std::array<double, kAxes>& wanted,
               StickMemory& memory) noexcept;

/// Volts of trolley and slew that the nominal crane needs for the path at the tick after the reference,
/// without the compensation of friction; 0 with Shaping::none.
[[nodiscard]] Volts feed_forward(const Design& design, const StickLimits& limits,
                                 const StickMemory& memory) noexcept;

/// True when nothing moves and nothing is pending.
[[nodiscard]] bool at_rest(const StickMemory& memory) noexcept;

}  // namespace crane::control
