/// [[excitation]] in scenario files.
#include <gtest/gtest.h>

#include "crane/experiment/metrics.hpp"
#include "crane/experiment/scenario.hpp"
#include "stack/data_files.hpp"

namespace crane::experiment {
namespace {

constexpr const char* kText = R"(description = "two excitations"
duration_s = 70
[[excitation]]
at_s = 0.5
axis = "trolley"
about_m = 0.75
amplitudes_m = [-0.24, 0.18]
frequencies_hz = [0.3333, 0.25]
duration_s = 60
[[excitation]]
at_s = 65
axis = "slew"
about_rad = 0.2
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string problems_of(const std::string& text) {
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  try {
    (void)parse_scenario(text, "x.toml", &rig);
  } catch (const configuration::ConfigurationError& error) {
    return error.what();
  }
  return "";
}

TEST(ScenarioExcitation, IsReadAsWritten) {
  const auto scenario = parse_scenario(kText, "x.toml");
  ASSERT_EQ(scenario.excitations.size(), 2U);
  const auto& trolley = scenario.excitations[0];
  EXPECT_EQ(trolley.at_s, 0.5);
  EXPECT_EQ(trolley.reference.axis, plant::kTrolley);
  EXPECT_EQ(trolley.reference.mean_position, 0.75);
  EXPECT_EQ(trolley.reference.sines[1].amplitude, 0.18);
  EXPECT_EQ(trolley.reference.sines[1].frequency_hz, 0.25);
  EXPECT_EQ(trolley.reference.sines[2].amplitude, 0);
  EXPECT_EQ(trolley.reference.duration_s, 60);
  EXPECT_EQ(scenario.excitations[1].reference.axis, plant::kSlew);
  EXPECT_EQ(scenario.excitations[1].reference.duration_s, 0);
  EXPECT_EQ(scenario.first_action_s(), 0.5);
  EXPECT_EQ(scenario.last_action_s(), 65);
}

TEST(ScenarioExcitation, MovesTheManeuver) {
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  const auto maneuver = maneuver_of(parse_scenario(kText, "x.toml", &rig), rig);
  EXPECT_EQ(maneuver.to[plant::kTrolley], 0.75);
  EXPECT_EQ(maneuver.from[plant::kSlew], 0);
  EXPECT_EQ(maneuver.to[plant::kSlew], 0.2);
}

TEST(ScenarioExcitation, ReportsItsProblemsWithTheirLines) {
  EXPECT_EQ(problems_of(kText), "");
  EXPECT_NE(problems_of(replaced(kText, "0.75", "1.2")).find("x.toml:6: excitation"), std::string::npos)
      << problems_of(replaced(kText, "0.75", "1.2"));
  EXPECT_NE(
      problems_of(replaced(kText, "[0.3333, 0.25]", "[0.3333]")).find("as many values as frequencies_hz"),
      std::string::npos);
  EXPECT_NE(problems_of(replaced(kText, "\"slew\"", "\"jib\"")).find("axis"), std::string::npos);
  EXPECT_NE(
      problems_of(replaced(kText, "at_s = 65", "at_s = 0.2")).find("later than the previous excitation"),
      std::string::npos);
}

}  // namespace
}  // namespace crane::experiment
