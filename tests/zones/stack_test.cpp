// Zones in closed loop: operator, supervisor, planner, controllers and the simulated tower crane.
#include <gmock/gmock.h>

#include <algorithm>

#include "guarded_crane.hpp"
#include "jog/operated_crane.hpp"

namespace crane::zones_test {
namespace {

using jog_test::OperatedCrane;
using testing::HasSubstr;

configuration::Rig zoned_rig() {
  auto rig = deployed_rig("virginia_tech_tower");
  rig.clearance = {.load_radius_m = 0.05, .suspension_height_m = 2, .cable_error = 0.1, .wind_mps2 = 0.1};
  rig.zones = {{.name = "wall", .position_x_m = 1.5, .size_x_m = 0.3, .size_y_m = 0.6, .top_m = 1.2},
               {.name = "mast",
                .shape = control::ZoneShape::cylinder,
                .position_y_m = 0.4,
                .radius_m = 0.1,
                .top_m = 1.2}};
  return rig;
}

class Watched {
 public:
  explicit Watched(const std::string& controller)
      : crane{controller, zoned_rig()},
        events_{crane.bus().subscriber(topics::event)},
        jogs_{crane.bus().publisher(topics::jog)} {
    crane.every_tick = [this] { look(); };
  }
  std::string move(std::size_t axis, double target) {
    msg::Request request{};
    request.kind = crane_REQUEST_MOVE;
    request.selected[axis] = true;
    request.target[axis] = target;
    return crane.ask(request);
  }
  std::string jog(const std::array<double, 3>& deflection) {
    msg::Request request{};
    request.kind = crane_REQUEST_JOG;
    for (std::size_t i = 0; i < 3; ++i) request.selected[i] = deflection[i] != 0;
    const auto reason = crane.ask(request);
    session_ = crane.last_id();
    deflection_ = deflection;
    return reason;
  }
  [[nodiscard]] std::string event(const std::string& code) {
    while (const auto event = events_.take())
      if (code == event->code) return event->what;
    return "";
  }
  OperatedCrane crane;
  double closest_m = 10;

 private:
  void look() {
    const auto& s = crane.state();
    closest_m = std::min(closest_m, gap_m(zoned_rig(), s));
    if (session_ == 0) return;
    msg::Jog jog{};
    jog.header.tick = s.header.tick;
    jog.request_id = session_;
    runtime::assign(jog.client, jog_test::kClient);
    jog.engaged = true;
    std::ranges::copy(deflection_, jog.deflection);
    EXPECT_TRUE(jogs_.publish(jog));
  }
  bus::Subscriber<msg::Event> events_;
  bus::Publisher<msg::Jog> jogs_;
  std::uint64_t session_ = 0;
  std::array<double, 3> deflection_{};
};

TEST(StackWithZones, RefusesAMoveIntoAZoneWithItsName) {
  Watched watched{"lqr"};
  EXPECT_THAT(watched.move(0, 1.29), HasSubstr("the target is inside zone wall"));
  EXPECT_EQ(watched.crane.status().state, crane_STATE_HOLD);
}

TEST(StackWithZones, GoesAroundAZoneOnTheStraightPath) {
  Watched watched{"lqr"};
  ASSERT_EQ(watched.move(1, 2.2), "");
  watched.crane.run(0.5);
  EXPECT_LT(watched.crane.run_until_hold(60), 60) << watched.crane.cause();
  EXPECT_EQ(watched.crane.cause(), "NONE");
  EXPECT_NEAR(watched.crane.state().slew_angle_rad, 2.2, 0.02);
  EXPECT_GT(watched.closest_m, 0);
}

TEST(StackWithZones, MovesBesideAZone) {
  Watched watched{"lqr"};
  ASSERT_EQ(watched.move(0, 0.9), "");
  watched.crane.run(0.5);
  EXPECT_LT(watched.crane.run_until_hold(10), 10) << watched.crane.cause();
  EXPECT_EQ(watched.crane.cause(), "NONE");
}

class EveryControllerNearZones : public testing::TestWithParam<const char*> {};

TEST_P(EveryControllerNearZones, StopsTheStickBeforeAZone) {
  Watched watched{GetParam()};
  ASSERT_EQ(watched.jog({1, 0, 0}), "");
  watched.crane.run(8);
  EXPECT_EQ(watched.crane.cause(), "ZONE");
  EXPECT_THAT(watched.event("zone"), HasSubstr("zone wall"));
  EXPECT_GT(watched.closest_m, 0);
}

TEST_P(EveryControllerNearZones, NeverSwingsTheLoadIntoAZoneOnItsPathToATargetCloseToIt) {
  Watched watched{GetParam()};
  ASSERT_EQ(watched.move(0, 1.15), "");
  watched.crane.run(10);
  EXPECT_GT(watched.closest_m, 0);
  EXPECT_THAT(watched.crane.cause(), testing::AnyOf("NONE", "ZONE"));
}

INSTANTIATE_TEST_SUITE_P(Zones, EveryControllerNearZones,
                         testing::Values("gain_scheduling_partial", "gain_scheduling_full", "anti_swing_pd",
                                         "delayed_1", "delayed_2", "fuzzy_generated", "lqr", "shaped_zv",
                                         "time_optimal", "none"),
                         [](const auto& controller) { return std::string{controller.param}; });

}  // namespace
}  // namespace crane::zones_test
