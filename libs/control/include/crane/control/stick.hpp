#pragma once
/// Stick mode: an operator commands the speeds of trolley, slew and hoist. With zv or zvd and the exact
/// cable length, the load comes to rest together with the axes.
///
/// 1. The unshaped speed u of each axis follows the commanded speed (`wanted`). An input shaper (shaper.hpp)
///    delays parts of each change of u,
///      v(t) = sum_i w_i u(t - t_i),   zv: w = 1/2, 1/2; t = 0, T/2   (Singer and Seering 1990)
///    The weights w_i are positive and their sum is 1, so that v stays between the smallest and the largest
///    u. The law limits each change of u so that |dv/dt| stays below the acceleration limit in every tick.
///    T is the swing period of the longest cable of the session, rounded up to an even number of ticks. The
///    hoist causes no swing and is not shaped.
/// 2. The integral of v is the shaped coordinate s. A load coordinate q (radius or angle of the load) follows
///      q'' = w^2 (s - q),   w = 2 pi / T
///    With zv and zvd, q comes to rest together with s, for every history of the stick.
/// 3. The reference of the suspension point P follows from the motion of the load: with the load at
///    y = q_r e^(i q_gamma) in the inertial frame,
///      P = y + (L / g) y''
///    This holds for a small swing angle without acceleration L'' of the cable.
///    |P| and arg(P) are the references of trolley and slew. While the jib slews at a constant rate, |P| is
///    smaller than the radius r of the load by about r gamma'^2 L / g, and the load stays on its circle.
///    Without slewing, and with the longest cable of the session, P = s.
///
/// Position limits: each tick simulates the stop that a release in this tick causes, including the pending
/// changes. If this stop would leave the limits, the law decelerates the axis instead of following the
/// commanded speed.
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "crane/control/law.hpp"
#include "crane/control/shaper.hpp"

namespace crane::control {

/// Number of ticks for which pending changes of speed can be stored. Limits the cable length: the
/// swing period of the longest cable must not exceed kStickSlots - 3 ticks.
inline constexpr std::size_t kStickSlots = 4096;

/// One axis; "unit" is m (trolley, hoist) or rad (slew).
struct StickAxisLimits {
  double speed = 0;               ///< largest |v|, unit/s; 0: the axis does not move
  double acceleration = 0;        ///< largest |dv/dt|, unit/s^2; > 0 when speed > 0
  double low = -1e9, high = 1e9;  ///< the reference stays inside, unit
};

struct StickLimits {
  std::array<StickAxisLimits, kAxes> axis{};
  Shaping shaping = Shaping::zv;  ///< none: P = s, and no planned swing
  double period_s = 0.01;         ///< tick, > 0
  double gravity_mps2 = 9.81;     ///< > 0
  double longest_cable_m = 100;   ///< longest cable of the session, > 0
};

/// Changes of v that act in this and in later ticks. The copy operations copy only the pending ticks.
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): only the pending slots have values
class PendingChanges {
 public:
  // NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)
  PendingChanges() = default;
  PendingChanges(const PendingChanges& other) noexcept { *this = other; }
  // NOLINTEND(cppcoreguidelines-pro-type-member-init)
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

/// Lowest and highest position of a motion.
struct PositionRange {
  double low = 0, high = 0;
};

struct StickAxis {
  double position = 0, speed = 0, acceleration = 0;  ///< s; the acceleration is that of the last tick
  double unshaped = 0;                               ///< u, unit/s
  double lag = 0;               ///< integral of u - v over the pending ticks while u is constant, unit
  PositionRange release{0, 0};  ///< positions during the stop that a release in this tick causes
  PendingChanges pending;
  double load_offset = 0, load_offset_rate = 0;  ///< q - s and its derivative; 0 for the hoist
};

/// Weights w_i and delays t_i of the shaper, in whole ticks.
struct ShaperImpulses {
  struct Impulse {
    std::size_t ticks = 0;
    double weight = 1;
  };
  std::array<Impulse, 3> impulse{};
  std::size_t count = 1;
  double mean_s = 0;          ///< mean delay
  double largest_weight = 1;  ///< largest weight
};

/// Suspension point and swing at one tick.
struct StickPoint {
  std::array<double, kAxes> position{};
  double radial_rad = 0, tangential_rad = 0;
};

struct StickMemory {
  std::array<StickAxis, kAxes> axis{};
  std::array<StickAxisLimits, kAxes> limits{};  ///< of s and u
  ShaperImpulses impulses;                      ///< of trolley and slew
  double frequency_radps = 0;                   ///< w
  std::array<StickPoint, 4> path{};             ///< newest first
  int rest_ticks = 0;                           ///< ticks for which s has been at rest; at most path.size()
};

/// @return all problems as "name = value: rule"; empty when the stick can be used
[[nodiscard]] std::vector<std::string> problems(const StickLimits& limits);

/// Begins at rest at the position of `reference`. An axis outside its limits may only move inwards.
/// @pre problems(limits).empty(); the reference rests: a session that began at speed could neither stay
/// inside the limits nor know the swing of the load
void begin(const StickLimits& limits, const Reference& reference, StickMemory& memory) noexcept;

/// Advances the reference by one tick; allocates no memory.
/// @param wanted  commanded speed per axis, unit/s; limited to the largest speed; a value that is not finite
/// counts as 0
/// @return reference at path[2]; its swing is that of path[1], because the command of a tick acts one tick
///   later; `start` and `feed_forward_v` are 0
Reference step(const StickLimits& limits, const std::array<double, kAxes>& wanted,
               StickMemory& memory) noexcept;

/// Voltages of trolley and slew with which the nominal crane without friction follows the path at path[1]; 0
/// with Shaping::none.
[[nodiscard]] Volts feed_forward(const Design& design, const StickLimits& limits,
                                 const StickMemory& memory) noexcept;

/// True when for path.size() ticks no axis has moved and no change of speed has been pending.
[[nodiscard]] bool at_rest(const StickMemory& memory) noexcept;

}  // namespace crane::control
