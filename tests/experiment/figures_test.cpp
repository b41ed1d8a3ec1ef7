#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "experiments/comparison_run.hpp"
#include "stack/data_files.hpp"

namespace crane::experiment {
namespace {

std::vector<std::string> figure_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator{CRANE_SCENARIOS})
    if (entry.path().stem().string().starts_with("figure_")) names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// "figure_4_07" to "4.7".
std::string number_of(const std::string& name) {
  return name.substr(7, 1) + "." + std::to_string(std::stoi(name.substr(9)));
}

experiments::PlannedRun plan_of(const std::string& figure) {
  const auto file = stack::find_scenario(figure);
  const Scenario defaults = load_scenario(file);
  const auto rig =
      configuration::load_rig(stack::find_rig(defaults.rig.empty() ? "virginia_tech_tower" : defaults.rig));
  return {load_scenario(file, &rig), rig, control::find_controller(defaults.controllers.at(0)),
          defaults.variants.empty() ? "" : defaults.variants.front()};
}

class Figure : public testing::TestWithParam<std::string> {};

TEST_P(Figure, RunsToItsEndWithItsFirstControllerAndVariant) {
  const auto plan = plan_of(GetParam());
  EXPECT_THAT(plan.scenario.description, testing::StartsWith("Figure " + number_of(GetParam()) + ": "))
      << "a file that extends another has a description of its own";
  const auto run = experiments::simulate(plan);
  EXPECT_EQ(run.stopped_because, "");
  ASSERT_TRUE(run.metrics);
  EXPECT_NEAR(run.samples.back().time_s, plan.scenario.end_s(), plan.rig.period_s);
  EXPECT_TRUE(run.metrics->settling_time_s) << "every figure begins with a crane that comes to rest";
  EXPECT_EQ(run.metrics->lost_ticks, 0U);
}

INSTANTIATE_TEST_SUITE_P(Dissertation, Figure, testing::ValuesIn(figure_names()),
                         [](const auto& figure) { return figure.param; });

TEST(Figures, AreThoseOfTheDissertationThatShowRuns) {
  std::set<std::string> wanted;
  const auto add = [&wanted](const std::string& chapter, int first, int last) {
    for (int i = first; i <= last; ++i)
      wanted.insert("figure_" + chapter + (i < 10 ? "_0" : "_") + std::to_string(i));
  };
  add("3", 7, 13);
  add("3", 22, 24);
  add("4", 10, 27);
  const auto names = figure_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()), wanted);
}

}  // namespace
}  // namespace crane::experiment
