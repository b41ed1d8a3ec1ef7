#include "cli/sensitivity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

experiments::PlannedRun plan_with(const std::string& controller) {
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  return {experiment::load_scenario(stack::find_scenario("maneuver_1"), &rig), rig,
          control::find_controller(controller), ""};
}

/// The plan after the named perturbation.
experiments::PlannedRun perturbed(const std::string& controller, const std::string& quantity, double value) {
  auto plan = plan_with(controller);
  for (const auto& perturbation : perturbations(plan))
    if (perturbation.quantity == quantity && perturbation.value == value) {
      perturbation.change(plan);
      return plan;
    }
  ADD_FAILURE() << quantity << " " << value << " is not among the perturbations";
  return plan;
}

TEST(Perturbations, ChangeTheTrueCraneAndNotTheDesignOfTheControllers) {
  const auto as_designed = plan_with("delayed_1");
  const auto cable = perturbed("delayed_1", "cable_length", -50);
  EXPECT_DOUBLE_EQ(experiment::with_start_of(cable.rig, cable.scenario).start.cable_length_offset_m, -0.5);
  EXPECT_EQ(cable.rig.design.cable_length_m, as_designed.rig.design.cable_length_m);
  const auto load = perturbed("delayed_1", "load_mass", 50);
  EXPECT_DOUBLE_EQ(experiment::with_start_of(load.rig, load.scenario).plant.load_mass_kg, 3);
  EXPECT_EQ(load.rig.design.crane.load_mass_kg, 2);
}

TEST(Perturbations, ChangeTheNamedQuantity) {
  EXPECT_DOUBLE_EQ(perturbed("delayed_1", "friction_compensation", -20).rig.design.friction[0].factor, 0.8);
  const auto delayed = perturbed("delayed_1", "command_delay", 2);
  ASSERT_GE(delayed.rig.terms.size(), 2u);
  EXPECT_EQ(delayed.rig.terms.back().name, "command_delay");
  EXPECT_DOUBLE_EQ(delayed.rig.terms.back().parameters.at("delay_s"), 0.02);
  const auto filtered = perturbed("delayed_1", "swing_filter", 0.02);
  EXPECT_TRUE(filtered.rig.sensing.filter_swing_angle);
  EXPECT_EQ(filtered.rig.sensing.swing_filter_ratio, 0.02);
  EXPECT_DOUBLE_EQ(perturbed("delayed_1", "gain", 50).rig.design.delayed_1_gain, -135);
  EXPECT_DOUBLE_EQ(perturbed("gain_scheduling_full", "gain", -50).rig.design.full_state_forward_gain_vpm, 2);
}

TEST(Perturbations, ReduceTheDelayByThatOfTheFilter) {
  const auto plan = perturbed("delayed_1", "swing_filter_for_delay", 0.05);
  EXPECT_TRUE(plan.rig.sensing.filter_swing_angle);
  const double load_period_s = 2 * M_PI / std::sqrt(9.81);
  EXPECT_NEAR(plan.rig.design.delayed_1_delay, 0.1 - 0.0450158 / load_period_s, 1e-6);
}

TEST(Perturbations, BeginWithTheNominalRunAndOmitGainsThatTheCraneDetermines) {
  const auto all = perturbations(plan_with("gain_scheduling_partial"));
  EXPECT_TRUE(all.front().quantity.empty());
  std::set<std::pair<std::string, double>> different;
  for (const auto& perturbation : all) {
    EXPECT_NE(perturbation.quantity, "gain");
    EXPECT_TRUE(different.insert({perturbation.quantity, perturbation.value}).second)
        << perturbation.quantity;
  }
}

TEST(SensitivityTable, DistinguishesSettledUnsettledAndStoppedRuns) {
  experiment::ComparedRun settled;
  settled.scenario = "maneuver_1";
  settled.controller = "none";
  settled.metrics.emplace();
  settled.metrics->settling_time_s = 3.456;
  settled.metrics->residual_swing_rad = 0.01;
  experiment::ComparedRun stopped = settled;
  stopped.stopped_because = "swing";
  stopped.metrics.reset();
  const std::vector<PerturbedRun> runs{{"", "", 0, settled}, {"load_mass", "%", 50, stopped}};
  std::ostringstream markdown, csv;
  write_sensitivity_markdown(markdown, runs);
  EXPECT_NE(markdown.str().find("| nominal | 3.46 / 0.57 |"), std::string::npos) << markdown.str();
  EXPECT_NE(markdown.str().find("| load_mass +50 % | stopped: swing |"), std::string::npos) << markdown.str();
  write_sensitivity_csv(csv, runs);
  EXPECT_NE(csv.str().find("\nmaneuver_1,none,load_mass,%,50,,,,,swing\n"), std::string::npos) << csv.str();
}

}  // namespace
}  // namespace crane::cli
