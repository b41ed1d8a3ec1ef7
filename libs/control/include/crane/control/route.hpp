#pragma once
/// Reference along a way: straight legs with parabolic blends.
///
/// Leg k runs from P_(k-1) to P_k with the profile sigma_k (0 to 1, trajectory.hpp) from the time t_k on:
///   r(t) = P_0 + sum over k of (P_k - P_(k-1)) sigma_k(t - t_k)
/// A leg begins before the one before it has ended, by at most the ramps of both. Then at most two legs are
/// active, with the acceleration limited to half of the reference acceleration each, and r stays inside the
/// triangle between the corner and the points where the overlap begins and ends. A corner is blended only
/// when the far side of this triangle is free.
#include <vector>

#include "crane/control/trajectory.hpp"
#include "crane/control/way.hpp"

namespace crane::control {

struct RouteStyle {
  bool blends = false;    ///< false: rests for delay_s at each waypoint
  bool overlaps = false;  ///< a blended leg begins before the one before it has ended
  double delay_s = 0;  ///< time over which a shaper distributes the reference, or the lag of the controller
  double speed_factor = 1;  ///< on all speeds, in (0, 1]
};

class Route {
 public:
  Route() = default;
  /// @param start  present reference; an axis that the rig does not have keeps it
  /// @throws std::invalid_argument when speeds or accelerations of `space` are outside the ranges of
  /// AxisLimits
  Route(const WaySpace& space, const plant::PerAxis& start, const std::vector<Waypoint>& points,
        const RouteStyle& style);

  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  [[nodiscard]] const plant::PerAxis& target() const noexcept { return target_; }
  /// At rest at the start before time 0, and at the target from duration_s() on. No allocation.
  [[nodiscard]] AxisReference at(std::size_t axis, double time_s) const noexcept;

 private:
  struct RouteLeg {
    AxisProfile profile;  ///< sigma
    plant::PerAxis way{};
    double begin_s = 0;
  };
  std::vector<RouteLeg> legs_;
  plant::PerAxis start_{}, target_{};
  double duration_s_ = 0;
};

/// One axis of a route as a profile (shaper.hpp). The route must outlive it.
struct RouteOfAxis {
  const Route& route;
  std::size_t axis;
  [[nodiscard]] AxisReference at(double time_s) const noexcept { return route.at(axis, time_s); }
};

}  // namespace crane::control
