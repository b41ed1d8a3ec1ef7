// Outcomes of the path search in named situations.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "path_spaces.hpp"

namespace crane::control {
namespace {

using plant::PerAxis;

TEST(PathToATarget, NamesTheZoneAroundTheTarget) {
  auto space = tower();
  space.zones = {
      {.name = "far", .shape = ZoneShape::cylinder, .position_x_m = -1, .radius_m = 0.1, .top_m = 2},
      {.name = "silo", .shape = ZoneShape::cylinder, .position_y_m = 0.7, .radius_m = 0.1, .top_m = 2}};
  const auto path = path_to(space, {0.7, 0, 1}, {0.7, std::numbers::pi / 2, 1});
  EXPECT_EQ(path.outcome, PathOutcome::target_inside);
  EXPECT_EQ(path.blocking, std::vector<std::size_t>{1});
}

TEST(PathToATarget, NamesTheWallThatEnclosesTheStart) {
  auto space = tower();
  space.zones = {{.name = "wall", .position_y_m = 0.75, .size_x_m = 0.1, .size_y_m = 1.5, .top_m = 1.99}};
  const auto path = path_to(space, {0.7, 0.2, 1}, {0.7, 2.5, 1});
  EXPECT_EQ(path.outcome, PathOutcome::no_path);
  EXPECT_EQ(path.blocking, std::vector<std::size_t>{0});
}

TEST(PathToATarget, RaisesTheLoadOfAGantryAboveAZone) {
  auto space = gantry();
  space.zones = {{.name = "box", .position_x_m = 1.5, .size_x_m = 0.4, .size_y_m = 1, .top_m = 1}};
  const auto path = path_to(space, {0.5, 0, 1.2}, {2.5, 0, 1.2});
  ASSERT_EQ(path.outcome, PathOutcome::by_waypoints);
  EXPECT_LT(path.points.front().position[2], 0.9);
  EXPECT_EQ(path.points.back().position, (PerAxis{2.5, 0, 1.2}));
}

TEST(PathToATarget, LeavesTheMarginOfAZoneThatContainsTheStart) {
  auto space = tower();
  space.zones = {{.name = "box", .position_x_m = 0.9, .size_x_m = 0.2, .size_y_m = 0.2, .top_m = 2}};
  EXPECT_EQ(path_to(space, {0.74, 0, 1}, {0.4, 0, 1}).outcome, PathOutcome::by_waypoints);
  EXPECT_EQ(path_to(space, {0.74, 0, 1}, {0.76, 0, 1}).outcome, PathOutcome::target_inside);
}

TEST(PathToATarget, DoesNotExistFromAPlaceThatIsNotFinite) {
  auto space = tower();
  space.zones = {{.name = "box", .position_x_m = 0.9, .size_x_m = 0.2, .size_y_m = 0.2, .top_m = 2}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(path_to(space, {nan, 0, 1}, {0.4, 0, 1}).outcome, PathOutcome::no_path);
  EXPECT_EQ(path_to(space, {0.4, 0, 1}, {0.4, nan, 1}).outcome, PathOutcome::no_path);
}

TEST(PathToATarget, IsRefusedFromFarOutsideTheCrane) {
  auto space = tower();
  space.zones = {{.name = "box", .position_x_m = 0.9, .size_x_m = 0.2, .size_y_m = 0.2, .top_m = 2}};
  for (const double far : {1e4, 1e9, 1e15, 1e300, -1e300})
    for (std::size_t axis = 0; axis < plant::kAxes; ++axis) {
      PerAxis from{0.4, 0, 1};
      from[axis] = far;
      if (axis == plant::kHoist && far < 0) continue;  // a measured cable length is at least 0.05 m
      const auto path = path_to(space, from, {0.4, 0, 1});
      EXPECT_EQ(path.outcome, PathOutcome::no_path) << "axis " << axis << " at " << far;
      EXPECT_TRUE(path.blocking.empty()) << "axis " << axis << " at " << far;
    }
}

TEST(PathToATarget, IsRefusedAmongAHundredZonesThatFillTheSpace) {
  auto space = tower();
  Random random{3};
  add_zones(space, random, 100);
  for (auto& zone : space.zones) zone.top_m = 2;
  const PerAxis from{0.7, 0, 1}, to{0.7, 2.5, 1};
  const auto path = path_to(space, from, to);
  EXPECT_TRUE(path.outcome == PathOutcome::no_path || path.outcome == PathOutcome::target_inside);
}

}  // namespace
}  // namespace crane::control
