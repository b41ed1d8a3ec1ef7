// A load that hangs inside the margin of one zone: every other zone stops the crane as if the first zone did
// not exist. CRANE_ZONE_SEED gives the first seed, CRANE_ZONE_RUNS the number of pairs.
#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "guarded_crane.hpp"

namespace crane::zones_test {
namespace {

using supervisor::Cause;

struct Pair {
  configuration::Rig rig{};  // without zones
  control::Zone left{};      // zone A: its margin contains the load at the start
  control::Zone ahead{};     // zone B: the load moves towards it
  double speed = 0;          // of the trolley m/s, or of the slew axis rad/s
  std::size_t axis = 0;      // the moving axis
  bool left_first = false;   // order of the zones in the rig file
};

/// A pair of zones that the load of a tower passes with one moving axis. Zone B lies on the way of the load;
/// zone A surrounds the start, more behind the load than ahead of it.
class RandomPair {
 public:
  explicit RandomPair(std::uint64_t seed) : random_{seed} {}

  Pair draw() {
    Pair pair{.rig = deployed_rig("virginia_tech_tower")};
    pair.rig.clearance = {.load_radius_m = between(0.02, 0.3), .suspension_height_m = 2, .wind_mps2 = 0.25};
    pair.axis = chance(0.5) ? plant::kTrolley : plant::kSlew;
    const double way = chance(0.5) ? 1 : -1;
    pair.speed = way * (chance(0.5) ? between(0.03, 0.1) : between(0.1, 0.4));
    pair.rig.start.position = {between(0.35, 0.9), between(-1, 1), 1};
    pair.left_first = chance(0.5);
    pair.left = surrounding(pair, way);
    pair.ahead = on_the_way(pair, way);
    return pair;
  }

 private:
  double between(double low, double high) { return std::uniform_real_distribution{low, high}(random_); }
  bool chance(double probability) { return std::bernoulli_distribution{probability}(random_); }

  static double clearance_of(const Pair& pair, const control::Zone& zone, double moved) {
    auto at = pair.rig.start.position;
    at[pair.axis] += moved;
    const auto reach =
        control::resting_space(pair.rig.clearance, pair.rig.plant.gravity_mps2, at[0], at[1], at[2]);
    return control::clearance_m(zone, reach, pair.rig.clearance.suspension_height_m);
  }
  control::Zone any(const Pair& pair, double moved, const char* name) {
    control::Zone zone{.name = name};
    auto at = pair.rig.start.position;
    at[pair.axis] += moved;
    zone.shape = chance(0.5) ? control::ZoneShape::box : control::ZoneShape::cylinder;
    zone.position_x_m = at[0] * std::cos(at[1]) + between(-0.1, 0.1);
    zone.position_y_m = at[0] * std::sin(at[1]) + between(-0.1, 0.1);
    zone.size_x_m = between(0.05, 0.6);
    zone.size_y_m = between(0.05, 0.6);
    zone.radius_m = between(0.02, 0.3);
    zone.top_m = between(1.3, 1.9);
    return zone;
  }
  control::Zone surrounding(const Pair& pair, double way) {
    for (;;) {
      auto zone = any(pair, -way * between(-0.1, 0.5), "left");
      const double gap_m = clearance_of(pair, zone, 0);
      if (gap_m > -0.4 && gap_m < -0.01 && clearance_of(pair, zone, way * 0.05) > gap_m) return zone;
    }
  }
  /// The first contact of a resting load with zone B is 0.25 to 0.7 (m or rad) away.
  control::Zone on_the_way(const Pair& pair, double way) {
    for (;;) {
      auto zone = any(pair, way * between(0.4, 1.2), "ahead");
      double first = 0;
      while (first < 0.7 && clearance_of(pair, zone, way * first) > 0) first += 0.01;
      if (first >= 0.25 && first < 0.7) return zone;
    }
  }
  std::mt19937_64 random_;
};

struct Drive {
  Cause cause = Cause::none;
  std::string zone;             // that stopped the crane
  double stopped_at = 0;        // position of the moving axis at the end
  double closest_ahead_m = 10;  // smallest distance of load or cable from zone B
};

Drive drive(const Pair& pair, std::vector<control::Zone> zones) {
  auto rig = pair.rig;
  rig.zones = std::move(zones);
  GuardedCrane crane{rig, rig};
  Drive result;
  double wanted = 0;
  for (int i = 0; i < 3000; ++i) {
    wanted += std::clamp(pair.speed - wanted, -0.002, 0.002);  // 0.2 m/s2: leaves a margin slowly
    PerAxis demand_v{};
    if (crane.armed())
      demand_v[pair.axis] =
          std::copysign(1.0, pair.speed) + std::clamp(20 * (wanted - crane.speed(pair.axis)), -8.0, 8.0);
    crane.tick(demand_v);
    result.closest_ahead_m =
        std::min(result.closest_ahead_m, gap_m({pair.ahead}, rig.clearance, crane.truth()));
    if (result.cause == Cause::none && crane.cause() != Cause::none) {
      result.cause = crane.cause();
      if (result.cause == Cause::zone) result.zone = rig.zones.at(crane.out.zone).name;
    }
  }
  result.stopped_at = pair.axis == plant::kTrolley ? crane.truth().trolley_m : crane.truth().slew_rad;
  return result;
}

TEST(ZonePairs, StopALoadThatLeavesOneZoneBeforeTheOtherZone) {
  const auto first = number("CRANE_ZONE_SEED", 1), runs = number("CRANE_ZONE_RUNS", 60);
  std::uint64_t stopped_ahead = 0;
  for (auto seed = first; seed < first + runs; ++seed) {
    const Pair pair = RandomPair{seed}.draw();
    const Drive alone = drive(pair, {pair.ahead});
    const Drive both = drive(
        pair, pair.left_first ? std::vector{pair.left, pair.ahead} : std::vector{pair.ahead, pair.left});
    if (alone.cause != Cause::zone) continue;  // a soft limit lies before zone B
    EXPECT_GT(alone.closest_ahead_m, 0) << "seed " << seed;
    EXPECT_EQ(both.cause, Cause::zone) << "seed " << seed;
    EXPECT_GT(both.closest_ahead_m, 0) << "seed " << seed;
    if (both.zone != "ahead") continue;  // zone A has ended a fast departure
    ++stopped_ahead;
    EXPECT_EQ(both.stopped_at, alone.stopped_at) << "seed " << seed;
    EXPECT_EQ(both.closest_ahead_m, alone.closest_ahead_m) << "seed " << seed;
  }
  std::cout << "seeds " << first << " to " << first + runs - 1 << ": " << stopped_ahead
            << " stops before the zone ahead\n";
  EXPECT_GT(stopped_ahead, runs / 2);
}

TEST(ZonePairs, LetALoadLeaveTheMarginsOfTwoZonesAtOnce) {
  Pair pair{.rig = deployed_rig("virginia_tech_tower"), .speed = 0.05, .axis = plant::kTrolley};
  pair.rig.clearance = {.load_radius_m = 0.1, .suspension_height_m = 2};
  pair.rig.start.position = {0.5, 0, 1};
  const auto post = [](const char* name, double x_m, double y_m) {
    return control::Zone{.name = name,
                         .shape = control::ZoneShape::cylinder,
                         .position_x_m = x_m,
                         .position_y_m = y_m,
                         .radius_m = 0.02,
                         .top_m = 1.9};
  };
  pair.ahead = post("ahead", 1.1, 0);
  const Drive result = drive(pair, {post("left", 0.45, 0.05), post("right", 0.42, -0.06), pair.ahead});
  EXPECT_EQ(result.zone, "ahead");
  EXPECT_GT(result.stopped_at, 0.7);
  EXPECT_GT(result.closest_ahead_m, 0);
}

}  // namespace
}  // namespace crane::zones_test
