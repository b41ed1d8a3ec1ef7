// The search for paths against independent code: a dense check of each path, and a flood fill of the free
// space.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

#include "crane/control/route.hpp"
#include "path_spaces.hpp"

namespace crane::control {
namespace {

using plant::PerAxis;

/// Distance of the resting load, its wind margin and its cable from the zones, from docs/zones.md, without
/// the code of the library.
double gap_at(const PathSpace& space, const PerAxis& at) {
  const double longest = at[2] * (1 + space.clearance.cable_error);
  const double radius = space.clearance.load_radius_m + 2 * space.clearance.wind_mps2 * longest / kGravity;
  const double lowest = space.clearance.suspension_height_m - longest - space.clearance.load_radius_m;
  const double x = at[0] * std::cos(at[1]), y = at[0] * std::sin(at[1]);
  double gap = 1e9;
  for (const Zone& zone : space.zones) {
    double beside = 0;
    if (zone.shape == ZoneShape::cylinder) {
      beside = std::hypot(x - zone.position_x_m, y - zone.position_y_m) - zone.radius_m;
    } else {
      const double qx = std::abs(x - zone.position_x_m) - zone.size_x_m / 2;
      const double qy = std::abs(y - zone.position_y_m) - zone.size_y_m / 2;
      beside = qx > 0 && qy > 0 ? std::hypot(qx, qy) : std::max(qx, qy);
    }
    const double apart = std::max(lowest - zone.top_m, zone.bottom_m - space.clearance.suspension_height_m);
    gap = std::min(gap, std::max(beside - radius, apart));
  }
  return gap;
}

PerAxis free_place(const PathSpace& space, Random& random, double gap_m) {
  for (int i = 0; i < 1000; ++i) {
    PerAxis at{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (space.axis[axis].present) at[axis] = random.in(space.axis[axis].low, space.axis[axis].high);
    if (gap_at(space, at) >= gap_m) return at;
  }
  return {};
}

/// Smallest distance on the path, and an error text when it leaves the limits or does not end at the target.
double closest_on(const PathSpace& space, PerAxis from, const std::vector<PerAxis>& corners) {
  double closest = gap_at(space, from);
  for (const auto& corner : corners) {
    const double length = std::hypot(corner[0] - from[0], 1.4 * (corner[1] - from[1]), corner[2] - from[2]);
    const int steps = 1 + static_cast<int>(length / 0.001);
    for (int i = 1; i <= steps; ++i) {
      PerAxis at{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        at[axis] = from[axis] + (corner[axis] - from[axis]) * i / steps;
      closest = std::min(closest, gap_at(space, at));
    }
    from = corner;
  }
  return closest;
}

/// True when cells of 1 cm connect both positions with the shortest cable; the flood fill passes where the
/// load has the clearance `gap_m`. Every path, with any cable length, has a counterpart with the shortest
/// cable.
bool flood_connects(const PathSpace& space, const PerAxis& from, const PerAxis& to, double gap_m) {
  const double cable = std::min({from[2], to[2], space.axis[2].low});
  const bool slews = space.axis[1].present;
  const double low = std::min(space.axis[0].low, from[0]), step = 0.01, turn = 0.01 / 1.31;
  const int columns = static_cast<int>((space.axis[0].high - low) / step) + 2;
  const int rows = slews ? static_cast<int>((space.axis[1].high - space.axis[1].low) / turn) + 2 : 1;
  const auto place = [&](int cell) {
    return PerAxis{low + step * (cell % columns), slews ? space.axis[1].low + turn * (cell / columns) : 0,
                   cable};
  };
  const auto cell_of = [&](const PerAxis& at) {
    const int row = slews ? static_cast<int>(std::lround((at[1] - space.axis[1].low) / turn)) : 0;
    return row * columns + static_cast<int>(std::lround((at[0] - low) / step));
  };
  std::vector<char> visited(static_cast<std::size_t>(columns * rows), 0);
  std::deque<int> open{cell_of(from)};
  while (!open.empty()) {
    const int cell = open.front();
    open.pop_front();
    if (cell == cell_of(to)) return true;
    for (const int next : {cell - 1, cell + 1, cell - columns, cell + columns}) {
      const bool beside = std::abs(next - cell) == 1 && next / columns != cell / columns;
      if (next < 0 || next >= columns * rows || beside || visited[static_cast<std::size_t>(next)] != 0)
        continue;
      if (gap_at(space, place(next)) < gap_m) continue;
      visited[static_cast<std::size_t>(next)] = 1;
      open.push_back(next);
    }
  }
  return false;
}

std::vector<PerAxis> corners_of(const Path& path) {
  std::vector<PerAxis> corners;
  for (const auto& point : path.points) corners.push_back(point.position);
  return corners;
}

struct Count {
  int straight = 0, around = 0, no_path = 0;
};

Count check_random_paths(const PathSpace& rig, unsigned seeds, int most_zones) {
  Count count;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    Random random{seed};
    auto space = rig;
    add_zones(space, random, 1 + random.below(most_zones));
    const PerAxis from = free_place(space, random, 0.021), to = free_place(space, random, 0.021);
    if (from[2] == 0 || to[2] == 0) continue;
    const Path path = path_to(space, from, to);
    if (path.outcome == PathOutcome::straight) {
      ++count.straight;
      EXPECT_GE(closest_on(space, from, {to}), kRestClearance_m - 1e-3) << "seed " << seed;
    } else if (path.outcome == PathOutcome::by_waypoints) {
      ++count.around;
      EXPECT_GE(closest_on(space, from, corners_of(path)), kRestClearance_m - 1e-3) << "seed " << seed;
      EXPECT_EQ(path.points.back().position, to) << "seed " << seed;
      for (const auto& point : path.points) {
        EXPECT_GT(point.speed_share, 0) << "seed " << seed;
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (space.axis[axis].present) {
            EXPECT_GE(point.position[axis], space.axis[axis].low - 1e-9) << "seed " << seed;
            EXPECT_LE(point.position[axis], space.axis[axis].high + 1e-9) << "seed " << seed;
          }
      }
    } else {
      ++count.no_path;
      EXPECT_EQ(path.outcome, PathOutcome::no_path) << "seed " << seed;
      EXPECT_FALSE(path.blocking.empty()) << "seed " << seed;
      // Passages narrower than a cell of the search (4 cm) beside kPassClearance_m may remain unknown.
      EXPECT_FALSE(flood_connects(space, from, to, kPassClearance_m + 0.04)) << "seed " << seed;
    }
  }
  return count;
}

TEST(RandomPaths, OfATowerStayOutOfTheZonesAndExistWhereTheFloodFindsThem) {
  const auto count = check_random_paths(tower(), 600, 40);
  EXPECT_GT(count.straight, 20);
  EXPECT_GT(count.around, 100);
  EXPECT_GT(count.no_path, 10);
}

TEST(RandomPaths, OfAGantryStayOutOfTheZonesAndExistWhereTheFloodFindsThem) {
  const auto count = check_random_paths(gantry(), 600, 4);
  EXPECT_GT(count.around, 100);
  EXPECT_GT(count.no_path, 10);
}

TEST(RandomPaths, AreEqualForEqualArguments) {
  Random random{7};
  auto space = tower();
  add_zones(space, random, 6);
  const PerAxis from = free_place(space, random, 0.05), to = free_place(space, random, 0.05);
  const auto first = path_to(space, from, to), second = path_to(space, from, to);
  EXPECT_EQ(corners_of(first), corners_of(second));
}

TEST(RandomRoutes, StayOutOfTheZonesWithBlendedCorners) {
  int blended = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    Random random{seed};
    auto space = tower();
    add_zones(space, random, 1 + random.below(6));
    const PerAxis from = free_place(space, random, 0.06), to = free_place(space, random, 0.06);
    const Path path = path_to(space, from, to);
    if (path.outcome != PathOutcome::by_waypoints) continue;
    const Route route{space, from, path.points, {.blends = true, .overlaps = true}};
    double rests_s = 0;
    for (double t = 0; t <= route.duration_s() + 0.1; t += 0.005) {
      const std::array at{route.at(0, t), route.at(1, t), route.at(2, t)};
      ASSERT_GE(gap_at(space, {at[0].position, at[1].position, at[2].position}), kRestClearance_m - 1e-3)
          << "seed " << seed << " at " << t;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_LE(std::abs(at[axis].speed), space.axis[axis].speed * 1.0001) << "seed " << seed;
        ASSERT_LE(std::abs(at[axis].acceleration), space.axis[axis].acceleration * 1.0001) << "seed " << seed;
      }
      if (std::abs(at[0].speed) + std::abs(at[1].speed) + std::abs(at[2].speed) < 1e-6) rests_s += 0.005;
    }
    EXPECT_EQ(route.at(0, route.duration_s()).position, to[0]);
    if (path.points.size() > 1 && rests_s < 0.15) ++blended;
  }
  EXPECT_GT(blended, 10);
}

}  // namespace
}  // namespace crane::control
