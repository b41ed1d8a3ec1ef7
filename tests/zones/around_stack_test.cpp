// Moves around zones in closed loop: operator, supervisor, planner, controllers and the simulated tower
// crane.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "crane/configuration/path_space.hpp"
#include "guarded_crane.hpp"
#include "jog/operated_crane.hpp"

namespace crane::zones_test {
namespace {

using jog_test::OperatedCrane;
using testing::HasSubstr;

configuration::Rig silo_rig() {
  auto rig = deployed_rig("virginia_tech_tower_silo");
  rig.start.position = {0.7, 0, 1};
  return rig;
}

class Carrier {
 public:
  explicit Carrier(const std::string& controller, const configuration::Rig& rig = silo_rig())
      : crane{controller, rig}, rig_{rig} {
    crane.every_tick = [this] { look(); };
  }
  std::string move(std::optional<double> trolley_m, std::optional<double> slew_rad,
                   std::optional<double> cable_m = {}) {
    const std::array target{trolley_m, slew_rad, cable_m};
    msg::Request request{};
    request.kind = crane_REQUEST_MOVE;
    for (std::size_t i = 0; i < 3; ++i) {
      request.selected[i] = target[i].has_value();
      request.target[i] = target[i].value_or(0);
    }
    return crane.ask(request);
  }
  /// @return seconds until HOLD
  double arrive(double longest_s = 90) { return 0.1 + (crane.run(0.1), crane.run_until_hold(longest_s)); }
  [[nodiscard]] std::array<double, 3> position() const {
    return {crane.state().trolley_position_m, crane.state().slew_angle_rad, crane.state().cable_length_m};
  }
  OperatedCrane crane;
  double closest_m = 10;

 private:
  void look() { closest_m = std::min(closest_m, gap_m(rig_, crane.state())); }
  configuration::Rig rig_;
};

/// Tolerance of the position on arrival, m or rad: 2 % of a move over 1 m or 1 rad. delayed_2 swings by up to
/// 0.06 m around its target on this rig, with and without zones.
double arrival_tolerance(std::string_view controller) { return controller == "delayed_2" ? 0.06 : 0.02; }

void expect_at(const Carrier& carrier, const std::array<double, 3>& target, std::string_view controller) {
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(carrier.position()[i], target[i], arrival_tolerance(controller)) << "axis " << i;
}

class EveryControllerAroundZones : public testing::TestWithParam<const char*> {};

TEST_P(EveryControllerAroundZones, CarriesTheLoadAroundTheSiloAndBackWithoutACause) {
  Carrier carrier{GetParam()};
  ASSERT_EQ(carrier.move(0.8, 2.0), "");
  const double there_s = carrier.arrive();
  EXPECT_EQ(carrier.crane.cause(), "NONE");
  expect_at(carrier, {0.8, 2.0, 1}, GetParam());
  ASSERT_EQ(carrier.move(0.7, 0), "");
  const double back_s = carrier.arrive();
  EXPECT_EQ(carrier.crane.cause(), "NONE");
  expect_at(carrier, {0.7, 0, 1}, GetParam());
  EXPECT_GT(carrier.closest_m, 0);
  RecordProperty("there_s", std::to_string(there_s));
  RecordProperty("back_s", std::to_string(back_s));
  RecordProperty("closest_m", std::to_string(carrier.closest_m));
}

TEST_P(EveryControllerAroundZones, FollowsAChangedTargetWhileItGoesAround) {
  Carrier carrier{GetParam()};
  ASSERT_EQ(carrier.move(0.8, 2.0), "");
  carrier.crane.run(4);
  ASSERT_EQ(carrier.move(0.6, 0.1), "");
  carrier.crane.run(2);
  ASSERT_EQ(carrier.move(0.9, 2.2), "");
  carrier.arrive();
  EXPECT_EQ(carrier.crane.cause(), "NONE");
  expect_at(carrier, {0.9, 2.2, 1}, GetParam());
  EXPECT_GT(carrier.closest_m, 0);
}

TEST_P(EveryControllerAroundZones, RaisesTheLoadAboveAZoneThatFillsThePath) {
  Carrier carrier{GetParam()};
  ASSERT_EQ(carrier.move(0.8, -2.2, 0.9), "");
  carrier.arrive();
  EXPECT_EQ(carrier.crane.cause(), "NONE");
  expect_at(carrier, {0.8, -2.2, 0.9}, GetParam());
  EXPECT_GT(carrier.closest_m, 0);
}

INSTANTIATE_TEST_SUITE_P(Zones, EveryControllerAroundZones,
                         testing::Values("gain_scheduling_partial", "gain_scheduling_full", "anti_swing_pd",
                                         "delayed_1", "delayed_2", "fuzzy_printed", "fuzzy_generated",
                                         "anti_swing_pd_optimised", "delayed_1_optimised",
                                         "delayed_2_optimised", "none", "lqr", "shaped_zv", "shaped_zvd",
                                         "shaped_ei", "time_optimal"),
                         [](const auto& controller) { return std::string{controller.param}; });

class Draw {
 public:
  explicit Draw(unsigned seed) : bits_{seed} {}
  double in(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_()) / 4294967296.0;
  }

 private:
  std::mt19937 bits_;
};

configuration::Rig random_rig(Draw& draw) {
  auto rig = silo_rig();
  rig.zones.clear();
  while (rig.zones.size() < 4) {
    const double radius_m = draw.in(0.3, 1.3), angle_rad = draw.in(-2.8, 2.8);
    control::Zone zone{.name = "zone " + std::to_string(rig.zones.size()),
                       .shape = control::ZoneShape::cylinder,
                       .position_x_m = radius_m * std::cos(angle_rad),
                       .position_y_m = radius_m * std::sin(angle_rad),
                       .radius_m = draw.in(0.02, 0.15),
                       .top_m = draw.in(0.9, 2)};
    if (std::hypot(zone.position_x_m - 0.7, zone.position_y_m) > zone.radius_m + 0.3)
      rig.zones.push_back(zone);
  }
  return rig;
}

TEST_P(EveryControllerAroundZones, ArrivesAtRandomTargetsAmongRandomZonesWithoutACause) {
  // CRANE_PATH_RUNS sets the number of random cranes per controller.
  const char* runs = std::getenv("CRANE_PATH_RUNS");
  const int seeds = runs == nullptr ? 3 : std::atoi(runs);
  int accepted = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    Draw draw{static_cast<unsigned>(seed)};
    const auto rig = random_rig(draw);
    const auto space = configuration::path_space_of(rig);
    Carrier carrier{GetParam(), rig};
    for (int i = 0; i < 3; ++i) {
      const std::array target{draw.in(0.2, 1.3), draw.in(-2.7, 2.7), draw.in(0.6, 1.2)};
      if (control::closest_zone(space, target).clearance_m < 0.1) continue;
      if (const auto reason = carrier.move(target[0], target[1], target[2]); !reason.empty()) {
        EXPECT_THAT(reason, HasSubstr("no path"));
        continue;
      }
      ++accepted;
      carrier.arrive();
      EXPECT_GT(carrier.closest_m, 0) << "seed " << seed;
      ASSERT_EQ(carrier.crane.cause(), "NONE") << "seed " << seed << " move " << i;
      expect_at(carrier, target, GetParam());
    }
  }
  EXPECT_GT(accepted, seeds);
}

/// The plan would be faster than the zone filter permits so close to the silo.
TEST(MovesAroundZones, OnAStraightPathAreNoFasterThanTheirClearancePermits) {
  auto rig = silo_rig();
  rig.start.position = {0.9, 2.74, 1.5};
  Carrier carrier{"time_optimal", rig};
  ASSERT_EQ(carrier.move(0.19, {}), "");
  carrier.arrive();
  EXPECT_EQ(carrier.crane.cause(), "NONE");
  EXPECT_NEAR(carrier.position()[0], 0.19, arrival_tolerance("time_optimal"));
  EXPECT_GT(carrier.closest_m, 0);
}

TEST(MovesAroundZones, AreRefusedWithTheZoneThatContainsTheTarget) {
  Carrier carrier{"lqr"};
  EXPECT_THAT(carrier.move(0.7, 1.0), HasSubstr("the target is inside zone silo"));
  EXPECT_EQ(carrier.crane.status().state, crane_STATE_HOLD);
}

TEST(MovesAroundZones, AreSearchedOncePerTickWhateverTheNumberOfRequests) {
  Carrier carrier{"lqr"};
  bus::Bus stranger = carrier.crane.stranger();
  auto requests = stranger.publisher(topics::request);
  auto replies = stranger.subscriber(topics::reply);
  constexpr int kFlood = 20;
  for (int i = 1; i <= kFlood; ++i) {
    msg::Request request{};
    request.id = static_cast<std::uint64_t>(i);
    runtime::assign(request.client, "stranger");
    request.kind = crane_REQUEST_MOVE;
    request.selected[1] = true;
    request.target[1] = 0.1 * i;
    ASSERT_TRUE(requests.publish(request));
  }
  carrier.crane.run(0.05);
  int accepted = 0, repeat = 0;
  while (const auto reply = replies.take()) {
    if (reply->header.source != crane_SOURCE_SUPERVISOR) continue;
    accepted += reply->accepted ? 1 : 0;
    repeat += std::string{reply->reason}.find("another move was requested in this tick") == 0 ? 1 : 0;
  }
  EXPECT_EQ(accepted, 1);
  EXPECT_EQ(repeat, kFlood - 1);
}

TEST(MovesAroundZones, AreRefusedWithTheZonesThatLeaveNoPath) {
  auto rig = silo_rig();
  rig.zones = {{.name = "wall",
                .position_x_m = 0,
                .position_y_m = 0.75,
                .size_x_m = 0.1,
                .size_y_m = 1.5,
                .top_m = 1.99}};
  Carrier carrier{"lqr", rig};
  EXPECT_THAT(carrier.move({}, 2.0), HasSubstr("no path leads to the target past zone wall ("));
  EXPECT_EQ(carrier.crane.status().state, crane_STATE_HOLD);
}

}  // namespace
}  // namespace crane::zones_test
