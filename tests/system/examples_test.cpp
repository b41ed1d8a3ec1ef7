/// The programs of examples/ behave as their first lines state.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../recording/temporary_directory.hpp"
#include "experiments/experiment_run.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using testing::HasSubstr;
constexpr std::uint32_t kDomain = 68;

Ended run_example(const std::string& name, const std::vector<std::string>& arguments) {
  return run_program(stack::program_directory() / name, arguments);
}

TEST(Example, OwnLawRunsBesideTheLawOfTheRigFile) {
  const auto ended = run_example("example_own_law", {});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("own_law                  settled after "));
  EXPECT_THAT(ended.output, testing::Not(HasSubstr("settled after -1")));
}

TEST(Example, OwnBoardMovesItsTrolley) {
  const auto ended = run_example("example_own_board", {});
  EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("trolley from 0.300 m to 0.400"));
}

TEST(Example, ReadRecordingDecodesByTheTextInTheFile) {
  const recording::TemporaryDirectory directory;
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  auto scenario = experiment::load_scenario(stack::find_scenario("maneuver_1"), &rig);
  scenario.duration_s = 1;
  experiments::TickLog log{directory / "run.mcap"};
  (void)experiments::run_in_process(experiment::with_start_of(rig, scenario),
                                    *control::find_controller("gain_scheduling_partial"), scenario, log);
  log.close();
  const auto ended =
      run_example("example_read_recording", {(directory / "run.mcap").string(), "crane/state"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("\"trolley_position_m\""));
  EXPECT_THAT(ended.output, HasSubstr("samples of crane/state"));
}

TEST(Example, FollowTopicPrintsTheTrolleyOfARunningStack) {
  RunningStack stack{kDomain, "virginia_tech_tower"};
  const auto ended = run_example("example_follow_topic", {"3", "--domain", std::to_string(kDomain), "--crane",
                                                          stack.bus_options().crane});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("trolley at "));
}

}  // namespace
}  // namespace crane::system_test
