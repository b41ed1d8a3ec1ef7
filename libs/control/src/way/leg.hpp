#pragma once
/// Straight legs of a way.
#include "crane/control/way.hpp"

namespace crane::control {

/// Duration and permitted speed of a leg at rest-to-rest.
struct Leg {
  bool is_free = false;
  double clearance_m = 0;  ///< smallest sampled
  double speed_share = 1;
  double duration_s = 0;  ///< from rest to rest
  std::size_t zone = 0;   ///< closest zone
};

/// Way over the ground at most, m.
[[nodiscard]] double ground_way_m(const plant::PerAxis& from, const plant::PerAxis& to) noexcept;

/// Share of the reference speeds for this leg at this clearance.
[[nodiscard]] double speed_share(const WaySpace& space, const plant::PerAxis& from, const plant::PerAxis& to,
                                 double clearance_m) noexcept;
/// Time at this share of the reference speeds, without ramps, s.
[[nodiscard]] double coasting_s(const WaySpace& space, const plant::PerAxis& from, const plant::PerAxis& to,
                                double share) noexcept;
/// Conservative advancement: each sample proves the way as far as its clearance exceeds the margin.
[[nodiscard]] Leg leg_of(const WaySpace& space, const plant::PerAxis& from, const plant::PerAxis& to,
                         double margin_m) noexcept;

}  // namespace crane::control
