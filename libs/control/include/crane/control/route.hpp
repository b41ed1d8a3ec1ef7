#pragma once
/// Reference along a path: straight legs with parabolic blends (J. J. Craig, Introduction to Robotics, 7.3).
///
/// Leg k runs from P_(k-1) to P_k with the profile sigma_k (0 to 1, trajectory.hpp) from the time t_k on:
///   r(t) = P_0 + sum over k of (P_k - P_(k-1)) sigma_k(t - t_k)
/// A blended leg begins before the previous leg has ended; the overlap is at most the shorter of the ramps of
/// both legs. Therefore at most two legs are active. Each of them has at most half of the reference
/// acceleration, and r stays inside the triangle whose vertices are the corner P_k and the two positions at
/// which the overlap begins and ends. A corner is blended only when the side of this triangle that is
/// opposite to the corner is free at the speeds of both legs.
#include <vector>

#include "crane/control/path.hpp"
#include "crane/control/trajectory.hpp"

namespace crane::control {

struct RouteStyle {
  bool blends = false;  ///< false: the reference rests for delay_s at each waypoint
  /// true: a blended leg begins before the previous leg ends; false: when the previous leg ends
  bool overlaps = false;
  double delay_s = 0;       ///< s, delay of the shaper, or lag of the controller behind its reference; >= 0
  double speed_factor = 1;  ///< factor of all speeds, in (0, 1]
};

class Route {
 public:
  Route() = default;
  /// @param start  present reference (m, rad, m of cable). An axis that the rig does not have stays there
  /// @throws std::invalid_argument when speeds, accelerations or jerks of `space` lead to limits outside the
  /// ranges of AxisLimits
  Route(const PathSpace& space, const plant::PerAxis& start, const std::vector<Waypoint>& points,
        const RouteStyle& style);

  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  [[nodiscard]] const plant::PerAxis& target() const noexcept { return target_; }
  /// Before time 0 the reference rests at the start, from duration_s() on at the target. Does not allocate.
  [[nodiscard]] AxisReference at(std::size_t axis, double time_s) const noexcept;

 private:
  struct RouteLeg {
    AxisProfile profile;            ///< sigma_k
    plant::PerAxis displacement{};  ///< P_k - P_(k-1), unit
    double begin_s = 0;             ///< t_k
  };
  std::vector<RouteLeg> legs_;
  plant::PerAxis start_{}, target_{};
  double duration_s_ = 0;
};

/// One axis of a route as the profile that shaper.hpp shapes. `route` must outlive this object.
struct RouteOfAxis {
  const Route& route;
  std::size_t axis;
  [[nodiscard]] AxisReference at(double time_s) const noexcept { return route.at(axis, time_s); }
};

}  // namespace crane::control
