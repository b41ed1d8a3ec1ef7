/// The crane holds its position in gusts, with the whole stack in lockstep.
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/comparison_run.hpp"
#include "stack/data_files.hpp"

namespace crane::experiment {
namespace {

Metrics held_in_gusts(const std::string& controller, const std::string& variant) {
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  const auto scenario = load_scenario(stack::find_scenario("hold_in_gusts"), &rig);
  const auto run = experiments::simulate({scenario, rig, control::find_controller(controller), variant});
  EXPECT_EQ(run.stopped_because, "") << controller << ", " << variant;
  return run.metrics.value_or(Metrics{});
}

/// Expected scatter of the deflection of a load without inertia, d(F) / (m g) = 2 d V sigma / (m g). The
/// variants have this wind. No feedback removes this part of the swing.
constexpr double kDeflection_rad = 2 * 0.0142 * 6 * 1.5 / (2 * 9.81);

TEST(Gusts, SwingFeedbackDampsWhatTheGustsExciteAndLeavesTheDeflection) {
  const double undamped = held_in_gusts("none", "gusts_along").swing_scatter_rad;
  for (const char* controller : {"gain_scheduling_partial", "lqr"}) {
    const double damped = held_in_gusts(controller, "gusts_along").swing_scatter_rad;
    EXPECT_LT(damped, 0.7 * undamped) << controller;
    EXPECT_GT(damped, 0.7 * kDeflection_rad) << controller;
  }
}

TEST(Gusts, TheObserverHalvesTheMotionOfTheTrolley) {
  for (const char* controller : {"gain_scheduling_partial", "lqr"}) {
    const auto motion_m = [&](const char* variant) {
      return held_in_gusts(controller, variant).deviation[plant::kTrolley].value();
    };
    EXPECT_LT(motion_m("gusts_along+observer"), 0.5 * motion_m("gusts_along")) << controller;
  }
}

}  // namespace
}  // namespace crane::experiment
