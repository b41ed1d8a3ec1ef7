/// Where fits begin, on data of a crane that shares no code with the model.
#include <gtest/gtest.h>

#include <cmath>

#include "data_of_truth.hpp"
#include "search/compare.hpp"
#include "search/search.hpp"

namespace crane::diagnosis {
namespace {

/// What a little delay promises is a valley of its own: a fit that begins there ends at a millisecond.
TEST(Singles, OfACommandThatComesMuchLaterBeginInTheRightValley) {
  truth::Case request;
  request.rig = "drive_axis";
  request.seed = 3;
  request.seconds = 20;
  request.effects = {{"command_delay", 3, "trolley"}};
  const DataOfTruth data(request);
  Study study(data.rig, data.train, data.test);
  study.learn_disturbance();
  const Fitted best = singles(study, Request{}).best;
  ASSERT_EQ(label_of(best.effects), "command_delay (trolley)");
  EXPECT_NEAR(best.effects[0].values[0], 0.105, 0.05 * 0.105);
}

}  // namespace
}  // namespace crane::diagnosis
