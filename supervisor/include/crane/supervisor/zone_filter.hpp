#pragma once
/// Predictive safety filter of the no-go zones (docs/zones.md). In each tick the filter bounds the reached
/// space: the reachable set of load, hook and cable if the voltages of this tick act and the next tick begins
/// a ramped stop (0 V, then closed brakes). If the reached space touches a zone, the filter replaces
/// the voltages by 0 V, and the ramped stop begins in this tick. The reached space of the previous tick
/// touched no zone and contains the motion of this stop. By induction the load stays out of the zones,
/// whatever the controllers demand.
///
/// Notation, horizontal, in coordinates of the ground: p position of the suspension point, y position of the
/// load, n = |y - p|. w speed of the load (three-dimensional), v speed of an axis, D travel of an axis until
/// standstill, D_p and v_p the same for the suspension point, t the duration of this travel, T the period, L
/// the measured cable length. The true length lies in [L (1 - cable_error), L (1 + cable_error)]; every term
/// uses the less favourable end of this interval.
///
/// 1. Travel of an axis. The voltages V of the previous, the present and the next tick are known. Friction
///    may or may not act. Therefore only voltages in the direction of the travel count:
///      v_most = v + k K (V_previous / 2 + V_present + V_next) T + a_load (t_r + T / 2)
///      D = v_most t_r + v_most^2 / (2 b)
///    v_most: largest speed of the axis; k = 1 + kGainTolerance; K: gain of the drive; a_load: acceleration
///    by the force of the load, the centrifugal and the Coriolis force; t_r = stopping_time_s: one tick, the
///    ramp and the closing time of the brake; b = brake_deceleration. V_previous / 2 and T / 2: v is the mean
///    speed of the previous tick. The hoist is speed-controlled with the time constant hoist_lag_s:
///      v_most = v + (k K V - v) 2.5 T / hoist_lag_s,   V: largest of the three voltages
/// 2. The suspension point stops inside the sector of trolley positions x +- D and slew angles +- D. A disc
///    with centre m and radius rho covers the sector.
/// 3. Energy. h: depth of the load below the suspension point; T_c: tension of the cable; tau = T_c / (load
///    mass L). The energy per mass E = w^2/2 - g h changes by dE/dt = tau (p - y) p', because besides gravity
///    only the tension does work. After p has stopped, E is constant, and the load stays within A of p:
///      A^2 = L^2 - (E/g)^2 <= n^2 + L w^2 / g + 2 L (E_end - E_now) / g
///    e = |y - m| + rho: largest distance of the load from a point where p can stop; n_most: largest n during
///    the stop; w_r <= w + v_p: speed of the load relative to p; kappa = 1 + w_r^2 / (g L): bound of tau L /
///    g for p'' = 0:
///      2 L (E_end - E_now) / g <= kappa (max(0, e^2 - n^2) + 2 D_p (w t + kappa g n_most t^2 / (2 L)))
///                                 + 2 L s^2 v_p^2 / g
///    First part: path-independent integral of (p - y) p' for a load at rest. Second part: motion of the load
///    during the stop. Third part: additional tension by p''; s = n_most / L is the sine of the swing.
/// 4. Constant wind shifts the centre of the swing by wind_mps2 L / g and its far end by 2 wind_mps2 L / g:
///      radius of the reach = rho + A + 2 wind_mps2 L / g + load_radius_m
///
/// A is at most L. Damping and friction would reduce the radius and are neglected.
///
/// Controlled stop. Before a ramped stop becomes necessary, `ahead` requests a controlled stop: the planner
/// decelerates with a_ref, the controllers damp the swing. The controlled stop ends without a ramped stop if
/// the reached space may move on by this distance before it touches a zone:
///   4 T v + max(0, v - a_ref / omega)^2 / (2 a_ref),   omega^2 = g / L
/// 4 T: time until the controllers follow the new reference.
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

struct ZoneInput {
  double sampled_s = 0;         ///< s, time at which the encoders were latched, clock of the bridge
  PerAxis position{}, speed{};  ///< unit, unit/s (MotionMemory)
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  PerAxis applied_v{};      ///< V, acts from the sample on
  PerAxis gate_output_v{};  ///< V, output of the gate in this tick
  int missing_ticks = 0;    ///< ticks since the sample, 0: the sample is of this tick
};

/// Number of sample intervals over which the velocity of the load is averaged.
inline constexpr std::size_t kZoneSpan = 4;

struct ZoneMemory {
  using Plane = std::array<double, 2>;
  struct PastSample {
    double sampled_s = 0;
    Plane pivot_m{};                ///< suspension point over the ground
    std::array<double, 3> cable{};  ///< unit vector from the suspension point to the load
  };
  std::array<PastSample, kZoneSpan + 1> recent{};  ///< newest first
  std::size_t samples = 0;                         ///< number of valid elements of `recent`
  PerAxis applied_v{}, previous_applied_v{};
  bool watching = false;  ///< true: the brakes were open in the previous tick
  /// m, least permitted clearance of each zone of the limits; below 0 while a load inside the margin of this
  /// zone leaves it
  std::array<double, control::kMostZones> permitted_m{};
};

struct ZoneVerdict {
  bool ahead = false;      ///< true: without a controlled stop now, a ramped stop may become necessary
  bool touched = false;    ///< true: the reached space touches a zone: 0 V, ramped stop
  std::size_t zone = 0;    ///< index of the zone that requires the stop; without a stop, of the zone whose
                           ///< clearance exceeds its permitted clearance least
  double clearance_m = 0;  ///< m, distance between the reached space and this zone; <= 0: they touch
};

/// A crane whose resting load has a clearance below 0 (a changed rig file, an axis moved by hand) may be
/// armed and leave the zone. The clearance of the reached space must not fall by more than kLeaveTolerance_m
/// below its largest value since the brakes first opened in the margin; arming again keeps it. Every other
/// zone stops the crane as usual. With this tolerance the crane can leave with the acceleration 2 g
/// kLeaveTolerance_m / L: 0.4 m/s2 for a cable of 1 m.
inline constexpr double kLeaveTolerance_m = 0.02;

/// Stores one sample. Call for every sample, also while the brakes are closed.
void observe_load(const Limits& limits, const ZoneInput& input, ZoneMemory& memory) noexcept;

/// Filters the voltages of one tick while the brakes are open. Without zones the verdict is
/// default-constructed.
/// @pre observe_load() has received the newest sample; at most control::kMostZones zones
[[nodiscard]] ZoneVerdict filter_zones(const Limits& limits, const ZoneInput& input,
                                       ZoneMemory& memory) noexcept;

/// The reached space, for tests and documents.
[[nodiscard]] control::ReachedSpace ramped_reach(const Limits& limits, const ZoneInput& input,
                                                 const ZoneMemory& memory) noexcept;

}  // namespace crane::supervisor
