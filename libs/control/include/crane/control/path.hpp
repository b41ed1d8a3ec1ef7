#pragma once
/// Search for the path of a move around the no-go zones. A path is a sequence of legs; a leg is straight in
/// the coordinates of the axes. Supervisor and planner call path_to() with the same data.
/// docs/zones.md#paths-around-zones describes the search and proves its rules.
///
/// The clearance of a position is the distance between a load that rests there (resting_space) and the
/// closest zone. A position is free when its clearance is at least kPassClearance_m.
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "crane/control/zone.hpp"

namespace crane::control {

/// Input of the search that depends on the rig only. configuration::path_space_of() reads it from the rig
/// file.
struct PathSpace {
  struct Axis {
    bool present = false;
    double low = 0, high = 0;  ///< permitted targets, unit: m, rad, m of cable
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

enum class PathOutcome : std::uint8_t {
  straight,       ///< the straight leg to the target is free at the reference speeds; no waypoints
  by_waypoints,   ///< `points` lead to the target: around zones, or straight at reduced speed
  target_inside,  ///< the target is nearer than kRestClearance_m to the first zone of `blocking`
  no_path         ///< no path was found; the zones of `blocking` bound the free space around the start
};

/// Least clearance of a target, and of the start and the end of a path, m: larger than the noise of
/// the clearance that the zone filter computes at rest.
inline constexpr double kRestClearance_m = 0.02;
/// Least clearance of all legs but the first and the last, m. At the lowest speed of a leg, the zone filter
/// does not stop the crane at this clearance.
inline constexpr double kPassClearance_m = 0.05;
/// Largest distance between start and target, m: longer than any move of a crane. The limit bounds
/// the time of a search from a wrong measured position.
inline constexpr double kLargestDistance_m = 1000;

/// End of a leg.
struct Waypoint {
  plant::PerAxis position{};  ///< trolley m, slew rad, cable m
  double speed_share = 1;     ///< speed of the leg / reference speeds, in (0, 1]
};

struct Path {
  PathOutcome outcome = PathOutcome::straight;
  std::vector<Waypoint> points{};       ///< without the start; the last one is the target
  std::vector<std::size_t> blocking{};  ///< indices of zones, without repetition
};

/// The path from `from` to `to`. Equal arguments give equal paths, bit for bit. The number of zones and the
/// 8000 nodes of the grid bound time and memory. The search may miss a passage whose width beyond
/// 2 kPassClearance_m is below the spacing of the grid (4 cm over the ground; more on a large crane).
/// @param from  measured trolley position m, slew angle rad, cable length m
/// @param to    target in the same units, inside the limits of the axes
/// @return no_path without `blocking` when a value is not finite or the distance exceeds kLargestDistance_m
[[nodiscard]] Path path_to(const PathSpace& space, const plant::PerAxis& from, const plant::PerAxis& to);

/// Replaces coordinates that the rig does not have or does not measure: slew angle 0, cable length
/// `space.cable_m`. A measured cable length is at least 0.05 m.
[[nodiscard]] plant::PerAxis completed(const PathSpace& space, plant::PerAxis position) noexcept;

/// The clearance of a position, m, and its zone (index); infinity without zones.
struct ClosestZone {
  double clearance_m = 0;
  std::size_t zone = 0;
};
[[nodiscard]] ClosestZone closest_zone(const PathSpace& space, const plant::PerAxis& position) noexcept;

/// Smallest clearance of the samples on the straight leg between two completed positions, m. A value below
/// kRestClearance_m + 1.5 mm is an upper bound: the first such sample ends the calculation.
[[nodiscard]] double straight_clearance_m(const PathSpace& space, const plant::PerAxis& from,
                                          const plant::PerAxis& to) noexcept;

/// Largest speed of the suspension point over the ground at this clearance, m/s, at which the zone filter
/// does not stop the crane; at least 0.03 m/s. docs/zones.md#paths-around-zones states the formula.
[[nodiscard]] double passing_speed_mps(const PathSpace& space, double clearance_m, double cable_m) noexcept;

}  // namespace crane::control
