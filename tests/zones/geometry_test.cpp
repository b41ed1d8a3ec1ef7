// Distances between zones and the space that a load can reach; paths of moves.
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "crane/control/zone.hpp"

namespace crane::control {
namespace {

constexpr double kGravity = 9.81;

Zone box() {
  return {.name = "box", .position_x_m = 1, .size_x_m = 0.4, .size_y_m = 0.2, .bottom_m = 0, .top_m = 1};
}
Zone cylinder() {
  return {.name = "mast", .shape = ZoneShape::cylinder, .position_y_m = 1, .radius_m = 0.1, .top_m = 1};
}
ReachedSpace space(double x_m, double y_m, double radius_m, double lowest_m = 0.5) {
  return {.x_m = x_m, .y_m = y_m, .radius_m = radius_m, .lowest_m = lowest_m};
}

TEST(ClearanceOfAZone, IsTheDistanceOfTheOutlinesBesideIt) {
  EXPECT_NEAR(clearance_m(box(), space(0.5, 0, 0.1), 2), 0.2, 1e-12);
  EXPECT_NEAR(clearance_m(box(), space(1.5, 0.5, 0.1), 2), 0.4, 1e-12);  // a corner: 3, 4, 5
  EXPECT_NEAR(clearance_m(cylinder(), space(0, 0, 0.1), 2), 0.8, 1e-12);
}

TEST(ClearanceOfAZone, IsNegativeInsideAndFallsTowardsTheMiddle) {
  EXPECT_NEAR(clearance_m(box(), space(0.85, 0, 0), 2), -0.05, 1e-12);
  EXPECT_NEAR(clearance_m(box(), space(1, 0, 0), 2), -0.1, 1e-12);
  EXPECT_NEAR(clearance_m(cylinder(), space(0, 1, 0.2), 2), -0.3, 1e-12);
}

TEST(ClearanceOfAZone, IsTheGapAboveIt) {
  EXPECT_NEAR(clearance_m(box(), space(1, 0, 0.1, 1.3), 2), 0.3, 1e-12);
}

TEST(ClearanceOfAZone, CountsTheCableAboveTheLoad) {
  auto beam = box();
  beam.bottom_m = 1, beam.top_m = 1.5;
  EXPECT_LT(clearance_m(beam, space(1, 0, 0.1, 0.2), 2), 0);
  EXPECT_GT(clearance_m(beam, space(1, 0, 0.1, 0.2), 0.9), 0);  // the beam is above the suspension point
}

TEST(RestingReach, ContainsLoadWindAndTheErrorOfTheCable) {
  const auto reach =
      resting_space({.load_radius_m = 0.1, .suspension_height_m = 2, .cable_error = 0.1, .wind_mps2 = 0.25},
                    kGravity, 1.2, std::numbers::pi / 2, 1);
  EXPECT_NEAR(reach.x_m, 0, 1e-12);
  EXPECT_NEAR(reach.y_m, 1.2, 1e-12);
  EXPECT_NEAR(reach.radius_m, 0.1 + 2 * 0.25 * 1.1 / kGravity, 1e-12);
  EXPECT_NEAR(reach.lowest_m, 0.8, 1e-12);
}

constexpr Clearance kSmall{.load_radius_m = 0.05, .suspension_height_m = 2, .cable_error = 0, .wind_mps2 = 0};
const char* in_path(const plant::PerAxis& from, const plant::PerAxis& to) {
  static const std::array zones{box(), cylinder()};
  const Zone* found = zone_in_path(zones, kSmall, kGravity, from, to, 0.02);
  return found == nullptr ? "none" : found->name.c_str();
}

TEST(PathOfAMove, NamesTheZoneThatItLeadsThrough) {
  EXPECT_STREQ(in_path({0.3, 0, 1.5}, {1.4, 0, 1.5}), "box");
  EXPECT_STREQ(in_path({1, 0.8, 1.5}, {1, 2.4, 1.5}), "mast");
  EXPECT_STREQ(in_path({0.3, 0, 1.5}, {0.6, 0.8, 1.5}), "none");
}

TEST(PathOfAMove, IsFreeAboveAZone) {
  EXPECT_STREQ(in_path({0.3, 0, 0.9}, {1.4, 0, 0.9}), "none");
  EXPECT_STREQ(in_path({0.3, 0, 0.9}, {1.4, 0, 1.1}), "box");  // lowers the load on the way
}

TEST(PathOfAMove, MayLeaveTheMarginOfAZoneButNotComeCloser) {
  EXPECT_STREQ(in_path({0.74, 0, 1.5}, {0.5, 0, 1.5}), "none");
  EXPECT_STREQ(in_path({0.74, 0, 1.5}, {0.76, 0, 1.5}), "box");
}

}  // namespace
}  // namespace crane::control
