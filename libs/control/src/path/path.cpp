#include "crane/control/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "grid.hpp"
#include "leg.hpp"

namespace crane::control {
namespace {

struct TimedPath {
  std::vector<Waypoint> points;
  double duration_s = 0;
};

/// Leg between two places of a path.
Leg leg_between(const PathSpace& space, const std::vector<PerAxis>& places, std::size_t i, std::size_t j) {
  if (i == 0 || j + 1 == places.size()) return end_leg(space, places[i], places[j]);
  return leg_of(space, places[i], places[j], kPassClearance_m);
}

/// Corners of a path over the grid, and places between them.
std::vector<PerAxis> thinned(const std::vector<PerAxis>& nodes) {
  constexpr std::size_t kRun = 4;  // nodes of a straight run between two places
  constexpr double kSameDirection = 1e-9;
  std::vector<PerAxis> kept{nodes.front()};
  std::size_t run = 0;
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    bool turns = i == 1 || i + 2 == nodes.size();  // next to the start and the target
    for (const auto axis : {kTrolley, kSlew})
      turns =
          turns || std::abs(nodes[i + 1][axis] - 2 * nodes[i][axis] + nodes[i - 1][axis]) > kSameDirection;
    if (!turns && ++run < kRun) continue;
    kept.push_back(nodes[i]);
    run = 0;
  }
  if (nodes.size() > 1) kept.push_back(nodes.back());
  return kept;
}

/// Fastest sequence of straight legs through places of the path: shortest path in the graph of all free legs
/// over at most kWindow places. The graph contains the path over the grid. Therefore a result exists.
TimedPath straightened(const PathSpace& space, const std::vector<PerAxis>& places) {
  constexpr std::size_t kWindow = 12;
  struct Best {
    double time_s = std::numeric_limits<double>::infinity();
    std::size_t before = 0;
    double share = 1;
  };
  std::vector<Best> best(places.size());
  best[0].time_s = 0;
  for (std::size_t j = 1; j < places.size(); ++j)
    for (std::size_t i = j > kWindow ? j - kWindow : 0; i < j; ++i) {
      const Leg leg = leg_between(space, places, i, j);
      if (leg.is_free && best[i].time_s + leg.duration_s < best[j].time_s)
        best[j] = {best[i].time_s + leg.duration_s, i, leg.speed_share};
    }
  TimedPath path{.points = {}, .duration_s = best.back().time_s};
  for (std::size_t j = places.size() - 1; j > 0; j = best[j].before)
    path.points.push_back({places[j], best[j].share});
  std::ranges::reverse(path.points);
  return path;
}

PerAxis at_cable(PerAxis position, double cable_m) noexcept {
  position[kHoist] = cable_m;
  return position;
}

/// The path at one cable length, with vertical legs at both ends.
TimedPath with_lifts(const PathSpace& space, const PerAxis& from, const PerAxis& to, double cable_m,
                     TimedPath path) {
  const auto add = [&](const PerAxis& a, const PerAxis& b) {
    if (a[kHoist] != b[kHoist]) path.duration_s += cruise_time_s(space, a, b, 1);
    return a[kHoist] != b[kHoist];
  };
  if (add(from, at_cable(from, cable_m)))
    path.points.insert(path.points.begin(), {.position = at_cable(from, cable_m)});
  if (add(at_cable(to, cable_m), to)) path.points.push_back({.position = to});
  return path;
}

std::optional<TimedPath> around(const PathSpace& space, const PerAxis& from, const PerAxis& to,
                                double cable_m, std::vector<char>& blocking) {
  const auto nodes = search_grid(space, at_cable(from, cable_m), at_cable(to, cable_m), blocking);
  if (!nodes) return std::nullopt;
  TimedPath path = straightened(space, thinned(*nodes));
  if (!std::isfinite(path.duration_s)) return std::nullopt;
  return with_lifts(space, from, to, cable_m, std::move(path));
}

/// Straight leg above the zones, with the longest cable at which it is free.
std::optional<TimedPath> over(const PathSpace& space, const PerAxis& from, const PerAxis& to,
                              double shortest_m, double longest_m) {
  constexpr int kHalvings = 8;
  const auto leg_at = [&](double cable_m) {
    return leg_of(space, at_cable(from, cable_m), at_cable(to, cable_m), kPassClearance_m);
  };
  if (!(shortest_m < longest_m) || !leg_at(shortest_m).is_free) return std::nullopt;
  double high_m = shortest_m, low_m = longest_m;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_m = (high_m + low_m) / 2;
    (leg_at(middle_m).is_free ? high_m : low_m) = middle_m;
  }
  std::optional<TimedPath> fastest;
  for (const double cable_m : {high_m, shortest_m}) {  // a higher hook permits a faster move
    const Leg leg = leg_at(cable_m);
    TimedPath path{.points = {{at_cable(to, cable_m), leg.speed_share}}, .duration_s = leg.duration_s};
    path = with_lifts(space, from, to, cable_m, std::move(path));
    if (!fastest || path.duration_s < fastest->duration_s) fastest = std::move(path);
  }
  return fastest;
}

void take_faster(std::optional<TimedPath> other, std::optional<TimedPath>& path) {
  if (other && (!path || other->duration_s < path->duration_s)) path = std::move(other);
}

std::vector<std::size_t> indices_of(const std::vector<char>& flags) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i] != 0) found.push_back(i);
  return found;
}

}  // namespace

Path path_to(const PathSpace& space, const PerAxis& measured, const PerAxis& wanted) {
  const PerAxis from = completed(space, measured), to = completed(space, wanted);
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    if (!std::isfinite(from[i]) || !std::isfinite(to[i])) return {.outcome = PathOutcome::no_path};
  const double distance_m = ground_distance_m(from, to) + std::abs(to[kHoist] - from[kHoist]);
  if (!(distance_m <= kLargestDistance_m)) return {.outcome = PathOutcome::no_path};
  const bool straight =
      zone_in_path(space.zones, space.clearance, space.gravity_mps2, from, to, kRestClearance_m) == nullptr;
  std::optional<TimedPath> path;
  if (straight) {
    const Leg leg = end_leg(space, from, to);
    if (leg.is_free && leg.speed_share >= 1) return {};
    path =
        TimedPath{.points = {{.position = to, .speed_share = speed_share(space, from, to, leg.clearance_m)}}};
    path->duration_s = cruise_time_s(space, from, to, path->points[0].speed_share);
  } else if (const auto target = closest_zone(space, to); !(target.clearance_m >= kRestClearance_m)) {
    return {.outcome = PathOutcome::target_inside, .blocking = {target.zone}};
  }
  const double longest_m = std::min(from[kHoist], to[kHoist]);
  const bool lifts = space.axis[kHoist].present && space.cable_measured;
  const double shortest_m = lifts ? std::min(longest_m, space.axis[kHoist].low) : longest_m;
  std::vector<char> blocking(space.zones.size(), 0);
  take_faster(around(space, from, to, longest_m, blocking), path);
  take_faster(over(space, from, to, shortest_m, longest_m), path);
  if (!path && shortest_m < longest_m) {
    std::ranges::fill(blocking, 0);
    path = around(space, from, to, shortest_m, blocking);
  }
  if (!path) return {.outcome = PathOutcome::no_path, .blocking = indices_of(blocking)};
  return {.outcome = PathOutcome::by_waypoints, .points = std::move(path->points)};
}

}  // namespace crane::control
