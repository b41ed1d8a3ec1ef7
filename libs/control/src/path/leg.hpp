#pragma once
/// Straight legs of a path.
#include "crane/control/path.hpp"

namespace crane::control {

using plant::kAxes;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;
using plant::PerAxis;

/// A straight leg at the largest permitted speed.
struct Leg {
  bool is_free = false;
  double clearance_m = 0;  ///< smallest sampled clearance
  double speed_share = 1;  ///< speed / reference speeds
  double duration_s = 0;   ///< from rest to rest
  std::size_t zone = 0;    ///< index of the closest zone
};

/// Upper bound of the distance of the suspension point over the ground, m.
[[nodiscard]] double ground_distance_m(const PerAxis& from, const PerAxis& to) noexcept;

/// Permitted speed / reference speeds on this leg at this clearance.
[[nodiscard]] double speed_share(const PathSpace& space, const PerAxis& from, const PerAxis& to,
                                 double clearance_m) noexcept;
/// Duration of the leg at `share` of the reference speeds, without ramps, s.
[[nodiscard]] double cruise_time_s(const PathSpace& space, const PerAxis& from, const PerAxis& to,
                                   double share) noexcept;
/// Conservative advancement: each sample proves that the leg is free for the distance by which its clearance
/// exceeds `least_clearance_m`.
[[nodiscard]] Leg leg_of(const PathSpace& space, const PerAxis& from, const PerAxis& to,
                         double least_clearance_m) noexcept;

}  // namespace crane::control
