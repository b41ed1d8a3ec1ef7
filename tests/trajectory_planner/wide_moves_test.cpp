/// Moves between the ends of the workspace in closed loop: operator, supervisor, planner, controllers and the
/// simulated tower crane.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "jog/operated_crane.hpp"

namespace crane::services {
namespace {

using jog_test::OperatedCrane;

struct Place {
  double trolley_m, slew_rad;
};

std::string move_to(OperatedCrane& crane, Place target) {
  msg::Request request{};
  request.kind = crane_REQUEST_MOVE;
  request.selected[0] = request.selected[1] = true;
  request.target[0] = target.trolley_m;
  request.target[1] = target.slew_rad;
  return crane.ask(request);
}

class EveryController : public testing::TestWithParam<std::string> {
 protected:
  /// Moves a crane with a short cable through the places. The swing stays below 0.55 rad, half a turn of the
  /// jib beside the mast included.
  static void expect_quiet_moves(Place start, std::initializer_list<Place> targets) {
    configuration::Rig rig = configuration::load_rig(std::string(CRANE_RIGS) + "/virginia_tech_tower.toml");
    rig.start.position = {start.trolley_m, start.slew_rad, 0.65};
    OperatedCrane crane{GetParam(), rig};
    double largest_rad = 0;
    crane.every_tick = [&] {
      largest_rad = std::max(largest_rad,
                             std::hypot(crane.state().swing_radial_rad, crane.state().swing_tangential_rad));
    };
    for (const Place target : targets) {
      ASSERT_EQ(move_to(crane, target), "");
      crane.run(0.1);
      crane.run_until_hold(60);
      EXPECT_EQ(crane.cause(), "NONE") << "to " << target.trolley_m << " m, " << target.slew_rad << " rad";
      EXPECT_NEAR(crane.state().trolley_position_m, target.trolley_m, 0.02);
      EXPECT_NEAR(crane.state().slew_angle_rad, target.slew_rad, 0.02);
    }
    EXPECT_LT(largest_rad, 0.55);
  }
};

TEST_P(EveryController, TurnsFromEndToEndWhileTheTrolleyRunsOutAndIn) {
  expect_quiet_moves({0.25, -2.7}, {{1.3, 2.7}, {0.25, -2.7}});
}

TEST_P(EveryController, TurnsAtTheEndOfTheJib) {
  expect_quiet_moves({1.3, 0}, {{1.3, 1.57}, {1.03, -2.2}, {1.03, 2.2}});
}

/// All laws except `none`, which does not reduce the swing, and delayed_2, which does not settle with a cable
/// of 0.65 m.
std::vector<std::string> settling_controllers() {
  std::vector<std::string> names;
  for (const control::Controller& controller : control::controllers())
    if (const std::string name{controller.name}; name != "none" && name != "delayed_2") names.push_back(name);
  return names;
}

class ReplacedMoves : public testing::TestWithParam<std::string> {};

TEST_P(ReplacedMoves, DoNotStopTheCrane) {
  constexpr int kSequences = 25;
  const configuration::Rig rig =
      configuration::load_rig(std::string(CRANE_RIGS) + "/virginia_tech_tower.toml");
  for (unsigned seed = 1; seed <= kSequences; ++seed) {
    std::mt19937 random{seed};
    const auto between = [&random](double low, double high) {
      return std::uniform_real_distribution{low, high}(random);
    };
    OperatedCrane crane{GetParam(), rig};
    for (int k = 0; k < 6 && crane.cause() == "NONE"; ++k) {
      ASSERT_EQ(move_to(crane, {between(0.25, 1.25), between(-2.5, 2.5)}), "");
      crane.run(between(0.2, 3));
    }
    crane.run_until_hold(60);
    EXPECT_EQ(crane.cause(), "NONE") << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheTower, ReplacedMoves,
                         testing::Values("time_optimal", "gain_scheduling_partial", "lqr", "shaped_zv",
                                         "shaped_zvd", "shaped_ei", "delayed_1", "delayed_1_optimised"),
                         [](const auto& name) { return name.param; });

INSTANTIATE_TEST_SUITE_P(OfTheTower, EveryController, testing::ValuesIn(settling_controllers()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace crane::services
