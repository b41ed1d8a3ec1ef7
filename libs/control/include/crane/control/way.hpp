#pragma once
/// Way of a move around the no-go zones: a pure search in the coordinates of the axes. Supervisor and planner
/// call it with the same data, so that an accepted way is the executed one. docs/zones.md#ways-around-zones.
///
/// Free space. A shorter cable is free wherever a longer one is (the resting reach shrinks on all sides and
/// its lower end rises). Every way in three coordinates therefore has a free counterpart at the shortest
/// cable: a search over trolley and slew at one cable length decides whether a way exists, and vertical
/// motions at both ends are free. Along a way of the length s over the ground the clearance changes by at
/// most s (a distance function), so that a sample with the clearance c proves the way up to c - margin.
///
/// Search: A* over a grid of trolley and slew. The cost is the time; a lower clearance permits less speed. A
/// shortest path through the visible corners of the result removes the steps of the grid.
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "crane/control/zone.hpp"

namespace crane::control {

/// What the search knows of a rig. configuration::way_space_of() makes it from the rig file.
struct WaySpace {
  struct Axis {
    bool present = false;
    double low = 0, high = 0;  ///< permitted targets, unit
    double speed = 0;          ///< reference speed, unit/s, > 0 when present
    double acceleration = 0;   ///< reference acceleration, unit/s^2, > 0 when present
    double jerk = std::numeric_limits<double>::infinity();  ///< of S-curves, unit/s^3
  };
  std::vector<Zone> zones;
  Clearance clearance;
  double gravity_mps2 = 9.81;
  std::array<Axis, plant::kAxes> axis{};
  bool cable_measured = true;
  double cable_m = 1;  ///< length of a cable that is not measured
};

enum class WayOutcome : std::uint8_t {
  straight,       ///< the straight move is free and may have full speed; no waypoints
  around,         ///< `points` leads to the target, around zones or slowly beside them
  target_inside,  ///< the target is inside the margin of the first zone of `blocking`
  no_way          ///< the zones of `blocking` bound the space that the load can reach from the start
};

/// Distance of a target or a resting load from the margin of a zone, m: the noise of the zone filter at rest
/// is smaller.
inline constexpr double kRestGap_m = 0.02;
/// Least distance from the margin of a zone on the way, except from the start and to the target, m: what the
/// filter needs at kSlowest_mps.
inline constexpr double kPassGap_m = 0.05;

/// End of a leg that is straight in the coordinates of the axes.
struct Waypoint {
  plant::PerAxis position{};  ///< trolley m, slew rad, cable m
  double speed_share = 1;     ///< of the reference speeds, in (0, 1]
};

struct Way {
  WayOutcome outcome = WayOutcome::straight;
  std::vector<Waypoint> points{};       ///< without the start; the last one is the target
  std::vector<std::size_t> blocking{};  ///< indices of zones, without repetition
};

/// The way from `from` to `to`. Equal arguments give equal ways, bit for bit; no clock, no random numbers.
/// Time and memory are bounded by 8000 nodes of the grid and the number of zones. A passage that is narrower
/// than the spacing of the grid (4 cm, or more on a large crane) beside kPassGap_m may not be found.
/// @param from  trolley m, slew rad, cable m as measured; @param to  the target, inside the limits
/// @return no_way without `blocking` when a value is not finite
[[nodiscard]] Way way_to(const WaySpace& space, const plant::PerAxis& from, const plant::PerAxis& to);

/// Position with the values that stand in for axes that are absent or not measured.
[[nodiscard]] plant::PerAxis completed(const WaySpace& space, plant::PerAxis position) noexcept;

/// Clearance of a resting load at this position from the closest zone, m. @return infinity without zones
struct ClosestZone {
  double clearance_m = 0;
  std::size_t zone = 0;
};
[[nodiscard]] ClosestZone closest_zone(const WaySpace& space, const plant::PerAxis& position) noexcept;

/// Smallest clearance on the straight path between two completed positions, m; below kRestGap_m: not free.
[[nodiscard]] double straight_clearance_m(const WaySpace& space, const plant::PerAxis& from,
                                          const plant::PerAxis& to) noexcept;

/// Largest speed of the suspension point over the ground at which the zone filter lets a load pass at this
/// clearance, m/s.
[[nodiscard]] double passing_speed_mps(const WaySpace& space, double clearance_m, double cable_m) noexcept;

}  // namespace crane::control
