/// `crane home` with a stack in real time: an emulated Servo-to-Go card and a crane with unknown positions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../recording/temporary_directory.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 65;

Ended crane(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--domain", std::to_string(kDomain), "--crane", crane_name()});
  return run_program(stack::program_directory() / "crane", arguments);
}

TEST(CraneHome, HomesTheTrolleyAndNamesTheAxesThatAreNotHomed) {
  const recording::TemporaryDirectory directory;
  const auto rig = directory / "near_its_mark.toml";
  recording::put_contents(rig, "extends = \"" + stack::find_rig("homing_servo_to_go").string() +
                                   "\"\n[start]\ntrolley_position_m = 0.09\n");
  RunningStack running{kDomain, rig.string(), stack::Plant::hardware};
  EXPECT_THAT(crane({"status"}).output, HasSubstr("not homed"));
  running.session().wait_for(crane_STATE_LOCKED, 5s);
  EXPECT_EQ(crane({"home", "--axis", "trolley"}).exit_code, 1) << "reset first";
  running.session().request_with_patience({.kind = crane_REQUEST_RESET}, "reset");
  EXPECT_THAT(crane({"move", "--trolley", "1.0"}).errors, HasSubstr("crane home"));
  auto ended = crane({"home", "--axis", "trolley", "--timeout", "60"});
  for (int i = 0; i < 2 && ended.exit_code != 0; ++i) {  // on a busy computer, lost ticks can stop the crane
    std::cout << ended.errors;
    EXPECT_FALSE(running.observer().states().back().position_known[0]);
    running.session().request_with_patience({.kind = crane_REQUEST_RESET}, "reset");
    ended = crane({"home", "--axis", "trolley", "--timeout", "60"});
  }
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("trolley done"));
  ASSERT_TRUE(running.until([&] { return running.observer().states().back().position_known[0]; }, 2s));
  double fastest_mps = 0;
  for (const auto& state : running.observer().states())
    if (!state.position_known[0]) fastest_mps = std::max(fastest_mps, std::abs(state.trolley_speed_mps));
  std::cout << "fastest before the position was known: " << fastest_mps << " m/s\n";
  EXPECT_LE(fastest_mps, 0.15);
  EXPECT_FALSE(running.observer().states().back().position_known[1]);
  const double ends_at_m = running.observer().states().back().trolley_position_m;
  EXPECT_GT(ends_at_m, 0.07) << "0.02 m off the switch at 0.05 m";
  EXPECT_LT(ends_at_m, 0.10) << "and what a stop from 0.05 m/s takes";
}

/// `crane home` resets the stop that ends the homing of an axis, but no stop of the operator.
TEST(CraneHome, EndsAtAStopOfTheOperatorBetweenTwoAxes) {
  const recording::TemporaryDirectory directory;
  const auto rig = directory / "near_its_mark.toml";
  recording::put_contents(rig, "extends = \"" + stack::find_rig("homing_servo_to_go").string() +
                                   "\"\n[start]\ntrolley_position_m = 0.09\n");
  RunningStack running{kDomain, rig.string(), stack::Plant::hardware};
  running.session().wait_for(crane_STATE_LOCKED, 5s);
  running.session().request_with_patience({.kind = crane_REQUEST_RESET}, "reset");
  ProgramRun home{stack::program_directory() / "crane",
                  {"home", "--axis", "trolley", "--axis", "slew", "--domain", std::to_string(kDomain),
                   "--crane", crane_name()}};
  const auto homed = [&running] {
    return !running.observer().statuses().empty() &&
           running.observer().statuses().back().cause == crane_CAUSE_HOMED;
  };
  ASSERT_TRUE(running.until(homed, 60s)) << home.errors();
  running.session().request({.kind = crane_REQUEST_STOP}, "stop");
  running.forget();
  EXPECT_EQ(home.wait(10s), 1);
  EXPECT_THAT(home.errors(), HasSubstr("OPERATOR_STOP"));
  running.listen(2s);
  for (const auto& status : running.observer().statuses())
    ASSERT_TRUE(status.state == crane_STATE_STOP_C1 || status.state == crane_STATE_LOCKED)
        << experiments::in_words(status);
}

}  // namespace
}  // namespace crane::system_test
