/// Moves with filtered swing angles, with the whole stack in lockstep.
#include <gtest/gtest.h>

#include "experiments/comparison_run.hpp"
#include "stack/data_files.hpp"

namespace crane::experiment {
namespace {

/// The check of the swing encoders compares the load with the pendulum under the trolley. The filter delays
/// the angles by 45 ms.
TEST(FilteredAngles, LeadToNoStopOfAHealthyCrane) {
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  for (const char* maneuver : {"maneuver_1", "maneuver_2", "maneuver_3"}) {
    const auto scenario = load_scenario(stack::find_scenario(maneuver), &rig);
    for (const char* controller : {"gain_scheduling_partial", "delayed_1", "fuzzy_printed", "lqr"}) {
      const auto run =
          experiments::simulate({scenario, rig, control::find_controller(controller), "filtered_angle"});
      EXPECT_EQ(run.stopped_because, "") << maneuver << ", " << controller;
      ASSERT_TRUE(run.metrics);
      EXPECT_TRUE(run.metrics->settling_time_s) << maneuver << ", " << controller;
    }
  }
}

}  // namespace
}  // namespace crane::experiment
