// Keys of a rig file for homing and for the origins of the positions.
#include <gmock/gmock.h>

#include "crane/configuration/rig.hpp"

namespace crane::configuration {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// The emulated rig, extended by these lines.
std::string rig_with(const std::string& lines) {
  return "extends = \"" CRANE_RIGS "/emulated_servo_to_go.toml\"\n" + lines;
}

std::vector<std::string> problems_with(const std::string& lines) {
  try {
    (void)parse_rig(rig_with(lines), "rig.toml");
  } catch (const ConfigurationError& error) {
    return error.problems();
  }
  return {};
}

constexpr const char* kHomes = "[encoder.trolley]\nzero = 'homing'\n";

TEST(RigHoming, AssumesThePositionOfTheStartUnlessTheFileSaysOtherwise) {
  for (const auto& drive : parse_rig(rig_with(""), "rig.toml").drives) {
    EXPECT_EQ(drive.zero, control::Zero::start);
    EXPECT_FALSE(drive.homes());
  }
}

TEST(RigHoming, HasUsableDefaults) {
  const auto rig =
      parse_rig(rig_with(std::string{kHomes} + "[homing.trolley]\nmark = 'limit_high'\n"), "rig.toml");
  const auto& trolley = rig.drives[plant::kTrolley];
  EXPECT_TRUE(trolley.homes());
  EXPECT_EQ(trolley.homing.position, trolley.high_limit);
  EXPECT_EQ(trolley.unhomed_position(), trolley.low_limit) << "the end that is farther from the mark";
  EXPECT_DOUBLE_EQ(trolley.homing.speed, trolley.reference_speed / 10);
  EXPECT_DOUBLE_EQ(trolley.homing.approach_speed, trolley.homing.speed / 5);
  EXPECT_EQ(trolley.homing.back_off, 0.02);
  EXPECT_EQ(trolley.homing.volt_limit_v, 5);
}

TEST(RigHoming, OfTheExampleIsAsWritten) {
  const auto rig = load_rig(CRANE_RIGS "/homing_servo_to_go.toml");
  for (const auto& drive : rig.drives) EXPECT_TRUE(drive.homes());
  EXPECT_EQ(rig.drives[plant::kSlew].homing.mark, control::Mark::input);
  EXPECT_EQ(rig.wiring.drives[plant::kSlew].mark_input, 11);
  EXPECT_EQ(rig.drives[plant::kHoist].homing.position, rig.drives[plant::kHoist].low_limit);
}

TEST(RigHoming, RefusesContradictions) {
  EXPECT_THAT(problems_with(kHomes), ElementsAre(HasSubstr("homing: ")));
  EXPECT_THAT(problems_with("[homing.trolley]\nmark = 'limit_low'\n"),
              ElementsAre(HasSubstr("zero = \"homing\"")));
  EXPECT_THAT(problems_with("[encoder.trolley]\nzero = 'absolute'\n"), ElementsAre(HasSubstr("incremental")));
  EXPECT_THAT(problems_with("[encoder.swing_radial]\nzero = 'homing'\n"),
              ElementsAre(HasSubstr("unknown key")));
  const auto with = [](const std::string& lines) {
    return problems_with(std::string{kHomes} + "[homing.trolley]\n" + lines);
  };
  EXPECT_THAT(with("mark = 'input'\nposition_m = 0.5\n"), ElementsAre(HasSubstr("needs mark_input")));
  EXPECT_THAT(with("mark = 'input'\n"), Contains(HasSubstr("position_m")));
  EXPECT_THAT(with("mark = 'limit_low'\nposition_m = 0.7\n"), ElementsAre(HasSubstr("soft margin")));
  EXPECT_THAT(with("mark = 'limit_low'\nspeed_mps = 2\n"),
              ElementsAre(HasSubstr("speed_mps = 2: must be in (0, ")));
  EXPECT_THAT(with("mark = 'limit_low'\nspeed_mps = 0.01\napproach_speed_mps = 0.02\n"),
              ElementsAre(HasSubstr("approach_speed_mps = 0.02")));
  EXPECT_THAT(with("mark = 'limit_low'\nvolt_limit_v = 11\nback_off_m = 0\n"),
              ElementsAre(HasSubstr("volt_limit_v"), HasSubstr("back_off_m")));
}

TEST(RigHoming, RequiresASeparateLineForAMark) {
  EXPECT_THAT(problems_with("[wiring.slew]\nmark_input = 10\n"), ElementsAre(HasSubstr("must be used once")));
}

}  // namespace
}  // namespace crane::configuration
