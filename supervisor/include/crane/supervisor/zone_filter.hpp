#pragma once
/// Predictive filter of the no-go zones. In each tick the filter bounds the reached space: the space that
/// load, hook and cable can reach if the voltages of this tick act and the next tick begins a ramped stop
/// (0 V, then closed brakes). If the reached space touches a zone, the filter replaces the voltages by 0 V,
/// and the ramped stop begins in this tick. docs/zones.md#the-filter derives the bound in four steps and
/// defines the symbols; kappa_K = 1 + kGainTolerance, t_r = stopping_time_s().
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
  /// true: the previous tick was filtered (brakes commanded open, no homing)
  bool watching = false;
  /// m, smallest permitted clearance of each zone of the limits: 0; negative for a zone whose margin the load
  /// is leaving
  std::array<double, control::kMostZones> permitted_m{};
};

struct ZoneVerdict {
  bool needs_controlled_stop = false;  ///< true: must begin now to exclude a later ramped stop
  bool needs_ramped_stop = false;      ///< true: the reached space touches a zone: 0 V, ramped stop
  /// Index of the zone that requires the stop; without a stop: of the zone with the smallest clearance minus
  /// permitted clearance.
  std::size_t zone = 0;
  double clearance_m = 0;  ///< m, distance between the reached space and this zone; <= 0: they touch
};

/// A crane whose resting load has a clearance below 0 (a changed rig file, an axis moved by hand) may be
/// armed and leave the zone. For this zone, the clearance of the reached space must not fall by more than
/// kLeaveTolerance_m below the permitted clearance (docs/zones.md#the-filter). With this tolerance the
/// crane can leave with the acceleration 2 g kLeaveTolerance_m / L: 0.4 m/s2 for a cable of 1 m.
inline constexpr double kLeaveTolerance_m = 0.02;

/// Stores one sample. Call for every sample, also while the brakes are closed.
void observe_load(const Limits& limits, const ZoneInput& input, ZoneMemory& memory) noexcept;

/// Judges the voltages of one tick. The caller replaces the voltages by 0 V if the verdict requires
/// a ramped stop. Call while the brakes are commanded open. Without zones, the verdict is
/// default-constructed.
/// @pre observe_load() has received the newest sample; at most control::kMostZones zones
[[nodiscard]] ZoneVerdict filter_zones(const Limits& limits, const ZoneInput& input,
                                       ZoneMemory& memory) noexcept;

/// The reached space, for tests and documents.
[[nodiscard]] control::ReachedSpace ramped_stop_space(const Limits& limits, const ZoneInput& input,
                                                      const ZoneMemory& memory) noexcept;

}  // namespace crane::supervisor
