/// The experiment with the whole stack recovers the friction of the simulated rigs.
#include "identification/friction_experiment.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "../recording/temporary_directory.hpp"
#include "crane/experiment/scenario.hpp"
#include "crane/plant/coordinates.hpp"
#include "identification/axis_data.hpp"
#include "stack/data_files.hpp"

namespace crane::identification {
namespace {

struct Case {
  const char* rig;
  std::size_t axis;
};

/// The friction of the simulated plant, from its rig file: b+, b-, c+, c-.
std::array<double, 4> truth(const configuration::Rig& rig, std::size_t axis) {
  for (const auto& term : rig.terms)
    if (term.name == "drive_friction" && term.axis == plant::kCoordinates[axis].name)
      return {term.parameters.at("viscous_positive_vspm"), term.parameters.at("viscous_negative_vspm"),
              term.parameters.at("coulomb_positive_v"), term.parameters.at("coulomb_negative_v")};
  throw std::runtime_error("the rig has no friction there");
}

std::array<identification::Estimate, 4> values(const identification::FrictionEstimate& e) {
  return {e.viscous_positive, e.viscous_negative, e.coulomb_positive, e.coulomb_negative};
}

class FrictionExperiment : public testing::TestWithParam<Case> {};

TEST_P(FrictionExperiment, FindsTheFrictionOfTheSimulatedRig) {
  const recording::TemporaryDirectory directory;
  FrictionExperimentOptions options;
  options.rig = stack::find_rig(GetParam().rig);
  options.axis = GetParam().axis;
  options.directory = directory / "out";
  options.in_process = true;
  const auto rig = configuration::load_rig(options.rig);
  const auto result = identify_friction(options);
  const auto expected = truth(rig, options.axis);
  const auto midpoint = values(result.estimates.midpoint);
  const auto dissertation = values(result.estimates.dissertation);
  for (std::size_t i = 0; i < 4; ++i) {
    std::cout << "true " << expected[i] << ", midpoint " << midpoint[i].value << " +- "
              << midpoint[i].standard_error << ", dissertation " << dissertation[i].value << '\n';
    EXPECT_NEAR(midpoint[i].value, expected[i], 0.05 * expected[i]) << i;
  }
  ASSERT_TRUE(result.estimates.midpoint_joint) << result.estimates.gain_refusal;
  EXPECT_NEAR(result.estimates.midpoint_joint->gain.value, result.estimates.midpoint.gain.value,
              0.02 * result.estimates.midpoint.gain.value);
  EXPECT_NEAR(result.stiction.positive.mean_v, expected[2], 0.05 * expected[2]);
  EXPECT_NEAR(result.stiction.negative.mean_v, expected[3], 0.05 * expected[3]);
  EXPECT_GE(result.stiction.positive.count, 3U);
  EXPECT_LT(result.compensated.rms, 0.2 * result.uncompensated.rms);
  EXPECT_TRUE(std::filesystem::exists(directory / "out" / "friction.svg"));
  EXPECT_TRUE(std::filesystem::exists(directory / "out" / "friction.json"));

  const auto identified = configuration::load_rig(result.fragment).design.friction[options.axis];
  EXPECT_NEAR(identified.viscous_positive_vspm, midpoint[0].value, 1e-4);
  EXPECT_NEAR(identified.viscous_negative_vspm, midpoint[1].value, 1e-4);
  EXPECT_NEAR(identified.coulomb_positive_v, midpoint[2].value, 1e-4);
  EXPECT_NEAR(identified.coulomb_negative_v, midpoint[3].value, 1e-4);
  EXPECT_NEAR(identified.stiction_negative_v, result.stiction.negative.mean_v, 1e-4);
  EXPECT_EQ(identified.factor, 1);
}

INSTANTIATE_TEST_SUITE_P(Rigs, FrictionExperiment,
                         testing::Values(Case{"virginia_tech_tower", plant::kTrolley},
                                         Case{"virginia_tech_tower", plant::kSlew},
                                         Case{"drive_axis", plant::kTrolley}),
                         [](const auto& test) {
                           return std::string{test.param.rig} + "_" +
                                  plant::kCoordinates[test.param.axis].name;
                         });

TEST(FrictionExperiment, RefusesADriveThatTheRigDoesNotHave) {
  const recording::TemporaryDirectory directory;
  FrictionExperimentOptions options;
  options.rig = stack::find_rig("drive_axis");
  options.axis = plant::kSlew;
  options.directory = directory / "out";
  EXPECT_THROW((void)identify_friction(options), configuration::ConfigurationError);
}

/// The default directory of a second experiment is that of the first one.
TEST(FrictionExperiment, NeverReplacesItsRigFile) {
  const recording::TemporaryDirectory directory;
  const auto text = "extends = \"" + stack::find_rig("virginia_tech_tower").string() + "\"\n";
  for (const char* name : {"identified.toml", "uncompensated.toml", "steps.toml"}) {
    FrictionExperimentOptions options;
    options.rig = directory / name;
    options.directory = directory / "";
    recording::put_contents(options.rig, text);
    EXPECT_THROW((void)identify_friction(options), configuration::ConfigurationError);
    EXPECT_EQ(recording::contents_of(options.rig), text);
  }
}

TEST(FrictionExperiment, GivesNoResultWithoutFriction) {
  const recording::TemporaryDirectory directory;
  FrictionExperimentOptions options;
  options.rig = stack::find_rig("virginia_tech_tower_ideal");
  options.directory = directory / "out";
  options.in_process = true;
  EXPECT_THROW((void)identify_friction(options), identification::IdentificationError);
  EXPECT_FALSE(std::filesystem::exists(directory / "out" / "identified.toml"));
}

TEST(AxisData, RefusesARunWithGaps) {
  recording::Table table;
  table.columns = {{"time_s", {}}, {"trolley_position_m", {}}, {"trolley_voltage_v", {}}};
  for (int k = 0; k < 300; ++k) {
    table.columns[0].values.push_back(0.01 * k + (k > 150 ? 0.01 : 0));
    table.columns[1].values.push_back(0);
    table.columns[2].values.push_back(0);
  }
  const auto rig = configuration::load_rig(stack::find_rig("drive_axis"));
  EXPECT_THROW((void)axis_run_from(table, rig, plant::kTrolley, 0, 10), identification::IdentificationError);
  auto ticks = table;
  ticks.columns.push_back({"tick", {}});
  for (int k = 0; k < 300; ++k)
    ticks.columns.back().values.push_back(k);  // ticks are late, but no tick is missing
  EXPECT_EQ(axis_run_from(ticks, rig, plant::kTrolley, 0, 10).position.size(), 300U);
  EXPECT_THROW((void)axis_run_from({}, rig, plant::kTrolley, 0, 10), identification::IdentificationError);
}

}  // namespace
}  // namespace crane::identification
