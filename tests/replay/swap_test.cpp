// The demand of another controller at recorded states.
#include "replay/swap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "recorded_crane.hpp"

namespace crane::replay_test {
namespace {

class Swap : public testing::Test {
 protected:
  void SetUp() override {
    RecordedCrane crane{file_, "virginia_tech_tower", "gain_scheduling_partial"};
    crane.arm();
    crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, true, false}, .target = {0.8, 0.5, 0}});
    crane.run(2);
    crane.ask(crane_REQUEST_STOP);
    crane.run(1);
    ticks_ = crane.finish();
  }
  recording::TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "run.mcap";
  std::uint64_t ticks_ = 0;
};

TEST_F(Swap, TheRecordedControllerDemandsTheSameInEveryTick) {
  const auto result = replay::swap_controller(file_, "gain_scheduling_partial");
  EXPECT_EQ(result.ticks, ticks_);
  EXPECT_FALSE(result.first_differs) << *result.first_differs;
  for (const auto& axis : result.largest) EXPECT_EQ(axis.difference_v, 0);
}

TEST_F(Swap, AnotherControllerDiffersAndTheTableShowsTheLargestDifference) {
  const auto result = replay::swap_controller(file_, "delayed_1");
  EXPECT_EQ(result.recorded, "gain_scheduling_partial");
  EXPECT_EQ(result.other, "delayed_1");
  EXPECT_EQ(result.ticks, ticks_);
  ASSERT_EQ(result.table.rows(), ticks_);
  const auto& recorded = *result.table.find("slew_recorded_v");
  const auto& other = *result.table.find("slew_other_v");
  std::size_t largest = 0;
  for (std::size_t row = 0; row < recorded.size(); ++row)
    if (std::abs(other[row] - recorded[row]) > std::abs(other[largest] - recorded[largest])) largest = row;
  EXPECT_GT(result.largest[1].difference_v, 0.5);
  EXPECT_EQ(result.largest[1].tick, largest);
  EXPECT_EQ(result.largest[1].recorded_v, recorded[largest]);
  EXPECT_EQ(result.largest[1].other_v, other[largest]);
}

/// All controllers run to the end; a second writer or a stopped supervisor would end the demands.
TEST_F(Swap, EveryControllerComputesADemandInEveryTick) {
  for (const auto& controller : control::controllers()) {
    SCOPED_TRACE(controller.name);
    const auto result = replay::swap_controller(file_, std::string{controller.name});
    EXPECT_EQ(result.ticks, ticks_);
    const auto& other = *result.table.find("trolley_other_v");
    EXPECT_TRUE(std::ranges::all_of(other, [](double v) { return std::isfinite(v); }));
    EXPECT_TRUE(std::ranges::any_of(other, [](double v) { return v != 0; }));
  }
}

TEST_F(Swap, RefusesAnUnknownController) {
  EXPECT_THROW((void)replay::swap_controller(file_, "bang_bang"), configuration::ConfigurationError);
}

}  // namespace
}  // namespace crane::replay_test
