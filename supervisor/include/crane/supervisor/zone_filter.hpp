#pragma once
/// Predictive filter of the no-go zones (docs/zones.md). Each tick it bounds the space that load, hook and
/// cable can reach if this tick passes its voltages and the next tick begins a ramped stop: 0 V, then closed
/// brakes. If this space touches a zone, the filter replaces the voltages by 0 V and the stop begins now.
/// The space of the previous tick, which touched no zone, contains the motion of this stop: the load stays
/// out of the zones, whatever the controllers demand.
///
/// Notation: p position of the suspension point over the ground, y of the load, n = |y - p|, w velocity of
/// the load, v speed of an axis, D travel of the suspension point until standstill, t the duration of this
/// travel, L cable length. L is known within [L (1 - cable_error), L (1 + cable_error)]; every term uses the
/// less favourable end.
///
/// 1. Travel of an axis. The voltages V of the previous, the present and the next tick are known. Friction
///    may act or not. Therefore only voltages in the direction of the travel are counted:
///      v_most = v + k K (V_previous / 2 + V_present + V_next) T + a_load t_r,   k = 1 + kGainTolerance
///      D = v_most t_r + v_most^2 / (2 b)
///    t_r = stopping_time_s: one tick, the ramp, and the closing time; b = brake_deceleration; a_load:
///    acceleration by the force of the load, the centrifugal and the Coriolis force.
///    The hoist is speed-controlled: v_most = v + (k K V - v) 2.5 T / lag.
/// 2. The suspension point stops inside the patch [x - D, x + D] x [slew - D, slew + D], which a disc with
///    centre m and radius rho covers.
/// 3. Energy. With the tension T_c of the cable, tau = T_c / (m L) and the energy per mass E = w^2/2 - g h,
///    the equations of motion (2.11) give dE/dt = tau (p - y) p'. Once p stands still, E is constant and the
///    load stays within A of p:
///      A^2 = L^2 - (E/g)^2 <= n^2 + L w^2 / g + 2 L (E_end - E_now) / g
///    With e = |y - m| + rho, the largest distance of the load from a stopping point, and kappa = tau L / g
///    <= 1 + w_r^2 / (g L), w_r <= w + v the speed of the load relative to the suspension point:
///      2 L (E_end - E_now) / g <= kappa (max(0, e^2 - n^2) + 2 D (w t + kappa g n_most t^2 / (2 L)))
///                                 + 2 L s^2 v^2 / g
///    The first part is the path-independent integral for a load at rest, the second the motion of the load
///    during the stop, the third the additional tension by braking: s = n_most / L is the sine of the swing.
/// 4. A constant wind shifts the centre of the swing by wind_mps2 L / g, and its far end by 2 wind_mps2 L /
/// g.
///      radius of the reach = rho + A + 2 wind_mps2 L / g + load_radius_m
///
/// A is at most L. Damping and friction would reduce the radius and are neglected.
///
/// Before a ramped stop becomes necessary, `ahead` requests a controlled stop: the planner decelerates with
/// a_ref, the controllers damp the swing. The controlled stop ends without a ramped stop if the zone is
/// farther than the space of the ramped stop by (v - a_ref/omega)^2 / (2 a_ref), for v > a_ref / omega,
/// omega^2 = g / L.
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

struct ZoneInput {
  double sampled_s = 0;
  PerAxis position{}, speed{};  ///< unit, unit/s (MotionMemory)
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  PerAxis applied_v{};      ///< V, acts from the sample on
  PerAxis gate_output_v{};  ///< V, output of the gate in this tick
  int missing_ticks = 0;    ///< ticks since the sample, 0: the sample is of this tick
};

/// Samples of the span over which the velocity of the load is averaged.
inline constexpr std::size_t kZoneSpan = 4;

struct ZoneMemory {
  using Plane = std::array<double, 2>;
  struct Seen {
    double sampled_s = 0;
    Plane pivot_m{};                ///< suspension point over the ground
    std::array<double, 3> cable{};  ///< unit vector from the suspension point to the load
  };
  std::array<Seen, kZoneSpan + 1> seen{};  ///< newest first
  std::size_t samples = 0;                 ///< number of valid elements of `seen`
  PerAxis applied_v{}, previous_applied_v{};
  bool watching = false;   ///< true: the brakes were open in the previous tick
  double permitted_m = 0;  ///< clearance that stops the crane; below 0 while it leaves the margin of a zone
};

struct ZoneVerdict {
  bool ahead = false;      ///< controlled stop: only an early deceleration avoids a ramped stop
  bool touched = false;    ///< ramped stop, 0 V: the reached space touches a zone
  std::size_t zone = 0;    ///< index of the closest zone
  double clearance_m = 0;  ///< distance of the reached space from this zone
};

/// A crane that hangs at rest inside the margin of a zone (a changed rig file, an axis moved by hand) may be
/// armed and leave: its clearance must not fall by more than this below the largest clearance since it came
/// into the margin, however often the crane is armed. The tolerance permits a departure with the acceleration
/// g kLeaveTolerance_m / (L / 2), 0.4 m/s2 for a cable of 1 m.
inline constexpr double kLeaveTolerance_m = 0.02;

/// Stores one sample. Call for every sample, also while the brakes are closed.
void observe_load(const Limits& limits, const ZoneInput& input, ZoneMemory& memory) noexcept;

/// One tick while brakes are open. Without zones the verdict is always that of a free crane.
/// @pre observe_load() has got the newest sample
[[nodiscard]] ZoneVerdict filter_zones(const Limits& limits, const ZoneInput& input,
                                       ZoneMemory& memory) noexcept;

/// Space that a ramped stop reaches if it begins one tick later, for tests and documents.
[[nodiscard]] control::ReachedSpace ramped_reach(const Limits& limits, const ZoneInput& input,
                                                 const ZoneMemory& memory) noexcept;

}  // namespace crane::supervisor
