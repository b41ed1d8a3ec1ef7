#include "crane/experiment/scenario.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <numbers>

#include "rig.hpp"

namespace crane::experiment {
namespace {

using configuration::ConfigurationError;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> problems_of(const std::string& text, const configuration::Rig* rig = nullptr) {
  try {
    (void)parse_scenario(text, "s.toml", rig);
  } catch (const ConfigurationError& error) {
    return error.problems();
  }
  return {};
}

TEST(Scenario, ReadsEveryKey) {
  const Scenario s = parse_scenario(R"(
description = "all keys"
duration_s = 12
load_mass_kg = 3.5
[start]
trolley_position_m = 0.3
slew_angle_deg = -90
cable_length_m = 0.8
swing_radial_deg = 18
swing_tangential_rad = 0.1
[[move]]
at_s = 1
trolley_position_m = 1
[[move]]
at_s = 4.5
slew_angle_rad = 0.5
cable_length_m = 0.9
[[kick]]
at_s = 2
radial_degps = 180
[[kick]]
at_s = 6
tangential_radps = -0.2
)",
                                    "deploy/scenarios/all_keys.toml");
  EXPECT_EQ(s.name, "all_keys");
  EXPECT_EQ(s.description, "all keys");
  EXPECT_EQ(s.load_mass_kg, 3.5);
  EXPECT_EQ(s.start[0], 0.3);
  EXPECT_DOUBLE_EQ(*s.start[1], -std::numbers::pi / 2);
  EXPECT_EQ(s.start[2], 0.8);
  EXPECT_DOUBLE_EQ(s.swing_radial_rad, std::numbers::pi / 10);
  EXPECT_EQ(s.swing_tangential_rad, 0.1);
  ASSERT_EQ(s.moves.size(), 2U);
  EXPECT_EQ(s.moves[0].target[0], 1);
  EXPECT_FALSE(s.moves[0].target[1]);
  EXPECT_EQ(s.moves[1].target[1], 0.5);
  EXPECT_EQ(s.moves[1].target[2], 0.9);
  ASSERT_EQ(s.kicks.size(), 2U);
  EXPECT_DOUBLE_EQ(s.kicks[0].radial_radps, std::numbers::pi);
  EXPECT_EQ(s.kicks[1].tangential_radps, -0.2);
  EXPECT_EQ(s.first_action_s(), 1);
  EXPECT_EQ(s.last_action_s(), 6);
  EXPECT_EQ(s.end_s(), 13);
}

TEST(Scenario, RunsTwentySecondsFromItsFirstActionUnlessItSaysOtherwise) {
  EXPECT_EQ(parse_scenario("description = \"d\"\n[[kick]]\nat_s = 3\nradial_radps = 1\n", "s.toml").end_s(),
            23);
  EXPECT_EQ(parse_scenario("description = \"d\"\n", "s.toml").end_s(), 20);
}

TEST(Scenario, ReportsEveryProblemAtOnceWithFileAndLine) {
  const auto problems = problems_of(R"(descripton = "typing error"
duration_s = 0
[start]
trolley_position_m = "here"
slew_angle_deg = 1
slew_angle_rad = 1
cable_length_m = 0
[[move]]
at_s = 5
[[move]]
at_s = 4
trolley_position_m = 1
[[kick]]
at_s = -1
)");
  EXPECT_THAT(problems, testing::Contains(HasSubstr("s.toml:1: descripton")));
  EXPECT_THAT(problems, testing::Contains(HasSubstr("s.toml:2: duration_s = 0: must be in (0, 86400]")));
  EXPECT_THAT(problems, testing::Contains(HasSubstr("s.toml:4: start.trolley_position_m = \"here\"")));
  EXPECT_THAT(problems,
              testing::Contains(HasSubstr(
                  "s.toml:5: start.slew_angle_deg = 1: give either this key or slew_angle_rad, not both")));
  EXPECT_THAT(problems,
              testing::Contains(HasSubstr("s.toml:7: start.cable_length_m = 0: must be in [0.001, 1000]")));
  EXPECT_THAT(problems, testing::Contains(HasSubstr("the move has no target")));
  EXPECT_THAT(problems, testing::Contains(HasSubstr("at_s = 4: must be later than the previous move")));
  EXPECT_THAT(problems, testing::Contains(HasSubstr("at_s = -1: must be in [0, 86400]")));
  EXPECT_THAT(problems, testing::Contains(HasSubstr("the kick has no rate")));
}

TEST(Scenario, NamesTheTravelThatAMoveLeaves) {
  const configuration::Rig rig = tower();
  const auto problems = problems_of(R"(description = "too far"
[start]
trolley_position_m = 1.9
[[move]]
at_s = 0.5
trolley_position_m = 2.4
slew_angle_deg = 200
)",
                                    &rig);
  EXPECT_THAT(
      problems,
      ElementsAre(
          testing::AllOf(HasSubstr("s.toml:3: start.trolley_position_m = 1.9: must be in [0.05, 1.25], "
                                   "the travel of virginia_tech_tower")),
          testing::AllOf(HasSubstr("s.toml:6: "),
                         HasSubstr("trolley_position_m = 2.4: must be in "
                                   "[0.1, 1.2], the travel of virginia_tech_tower minus the soft margin")),
          testing::AllOf(HasSubstr("s.toml:7: "),
                         HasSubstr("slew_angle_deg = 200: must be in "
                                   "[-175, 175], the travel of virginia_tech_tower minus the soft margin"))));
}

TEST(Scenario, AllowsATargetExactlyOnTheMarginInDegrees) {
  const configuration::Rig rig = tower();
  EXPECT_THAT(problems_of("description = \"d\"\n[[move]]\nat_s = 0\nslew_angle_deg = 175\n", &rig),
              testing::IsEmpty());
}

TEST(Scenario, RefusesATargetOfADriveThatTheRigDoesNotHave) {
  configuration::Rig rig = tower();
  rig.name = "gantry";
  rig.drives[1].present = false;
  EXPECT_THAT(problems_of("description = \"d\"\n[[move]]\nat_s = 0\nslew_angle_deg = 5\n", &rig),
              ElementsAre(HasSubstr("slew_angle_deg = 5: gantry has no slew drive")));
}

TEST(Scenario, StatesItsDefaultRigControllersAndVariants) {
  const Scenario s = parse_scenario(
      "description = \"d\"\nrig = \"gantry\"\ncontrollers = [\"delayed_1\", \"none\"]\n"
      "variants = [\"slow_reference+no_compensation\"]\ncable_length_offset_m = 0.25\n",
      "s.toml");
  EXPECT_EQ(s.rig, "gantry");
  EXPECT_THAT(s.controllers, ElementsAre("delayed_1", "none"));
  EXPECT_THAT(s.variants, ElementsAre("slow_reference+no_compensation"));
  EXPECT_EQ(s.cable_length_offset_m, 0.25);
  EXPECT_EQ(with_start_of(tower(), s).start.cable_length_offset_m, 0.25);
  EXPECT_THAT(problems_of("description = \"d\"\ncontrollers = [\"pid\"]\nvariants = [\"ideal+windy\"]\n"),
              ElementsAre(HasSubstr("s.toml:2: controllers"), HasSubstr("s.toml:3: variants")));
}

TEST(Scenario, TakesMissingKeysFromTheExtendedFile) {
  const auto directory = std::filesystem::path{testing::TempDir()} / "scenario_test";
  std::filesystem::create_directories(directory);
  std::ofstream{directory / "base.toml"}
      << "description = \"base\"\nduration_s = 7\n[start]\ntrolley_position_m = 0.3\ncable_length_m = 0.8\n"
         "[[move]]\nat_s = 1\ntrolley_position_m = 1\n[[move]]\nat_s = 2\ntrolley_position_m = 0.5\n";
  const Scenario s = parse_scenario(
      "extends = \"base.toml\"\ndescription = \"mine\"\n[start]\ntrolley_position_m = 0.4\n"
      "[[move]]\nat_s = 3\nslew_angle_deg = 90\n",
      (directory / "s.toml").string());
  std::filesystem::remove_all(directory);
  EXPECT_EQ(s.description, "mine");
  EXPECT_EQ(s.duration_s, 7);
  EXPECT_EQ(s.start[plant::kTrolley], 0.4);
  EXPECT_EQ(s.start[plant::kHoist], 0.8);
  ASSERT_EQ(s.moves.size(), 1U) << "lists are taken whole";
  EXPECT_EQ(s.moves[0].at_s, 3);
}

TEST(Scenario, NamesTheFileThatCannotBeRead) {
  try {
    (void)load_scenario("/nowhere/s.toml");
    FAIL();
  } catch (const ConfigurationError& error) {
    EXPECT_THAT(error.problems(), ElementsAre(HasSubstr("/nowhere/s.toml")));
  }
}

TEST(Scenario, StartsTheRigAtItsPositionsWithItsLoad) {
  configuration::Rig rig = tower();
  rig.start.position = {0.25, 0.1, 1};
  Scenario scenario;
  scenario.start[0] = 0.9;
  scenario.swing_radial_rad = 0.2;
  scenario.load_mass_kg = 4;
  const configuration::Rig started = with_start_of(rig, scenario);
  EXPECT_THAT(started.start.position, ElementsAre(0.9, 0.1, 1));
  EXPECT_EQ(started.start.swing_radial_rad, 0.2);
  EXPECT_EQ(started.plant.load_mass_kg, 4);
  EXPECT_EQ(started.design.crane.load_mass_kg, rig.design.crane.load_mass_kg);
}

TEST(Scenario, EveryFileOfTheProjectIsValidOnItsRig) {
  const configuration::Rig dissertation = tower();
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator{CRANE_SCENARIOS}) {
    const std::string name = load_scenario(entry.path()).rig;
    const configuration::Rig rig =
        name.empty() ? dissertation
                     : configuration::load_rig(std::filesystem::path{CRANE_RIGS} / (name + ".toml"));
    EXPECT_NO_THROW((void)load_scenario(entry.path(), &rig)) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 5);
}

TEST(Scenario, TheThreeManeuversAreTheDissertations) {
  const std::filesystem::path directory{CRANE_SCENARIOS};
  const Scenario first = load_scenario(directory / "maneuver_1.toml");
  const Scenario second = load_scenario(directory / "maneuver_2.toml");
  const Scenario third = load_scenario(directory / "maneuver_3.toml");
  EXPECT_EQ(first.start[0], 0.25);
  EXPECT_EQ(first.moves.at(0).target[0], 1.0);
  EXPECT_FALSE(first.moves.at(0).target[1]);
  EXPECT_EQ(second.start[0], 0.9);
  EXPECT_DOUBLE_EQ(*second.moves.at(0).target[1], std::numbers::pi / 2);
  EXPECT_FALSE(second.moves.at(0).target[0]);
  EXPECT_EQ(third.moves.at(0).target[0], 1.0);
  EXPECT_DOUBLE_EQ(*third.moves.at(0).target[1], std::numbers::pi / 2);
}

}  // namespace
}  // namespace crane::experiment
