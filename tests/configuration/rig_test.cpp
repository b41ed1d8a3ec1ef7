#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "rig_text.hpp"

namespace crane::configuration {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(RigFile, HasTheDissertationsTower) {
  const Rig rig = load_rig(kTower);
  EXPECT_EQ(rig.name, "virginia_tech_tower");
  EXPECT_EQ(rig.path, kTower);
  EXPECT_EQ(rig.kind, RigKind::tower);
  EXPECT_EQ(rig.period_s, 0.01);
  EXPECT_EQ(rig.plant.trolley_inertia_kg, 22.46);
  EXPECT_EQ(rig.plant.trolley_mass_kg, 1.97);
  EXPECT_EQ(rig.plant.jib_inertia_kgm2, 7.2);
  EXPECT_EQ(rig.plant.slew_gain_radps2pv, 1.14);
  ASSERT_EQ(rig.terms.size(), 2U);
  EXPECT_EQ(rig.terms[0].axis, "trolley");
  EXPECT_EQ(rig.terms[0].parameters.at("viscous_negative_vspm"), 6.0);
  EXPECT_EQ(rig.terms[1].parameters.at("coulomb_positive_v"), 0.7);
  EXPECT_EQ(rig.controller, "gain_scheduling_partial");
  EXPECT_EQ(rig.start.position, (std::array<double, 3>{0.3, 0, 1}));
}

TEST(RigFile, HasTheCountsOfTheTowersEncoders) {
  const Rig rig = load_rig(kTower);
  // Lines, quadrature and gear of chapter 4 of the dissertation, with the rounding of the file.
  EXPECT_DOUBLE_EQ(rig.encoders[0].counts_per_unit, 2000 * 4 / 0.0127);
  EXPECT_DOUBLE_EQ(rig.encoders[1].counts_per_unit, 2000 * 4 * 45 / (2 * std::numbers::pi));
  EXPECT_DOUBLE_EQ(rig.encoders[2].counts_per_unit, 2000 * 4 / 0.05);
  EXPECT_DOUBLE_EQ(rig.encoders[3].counts_per_unit, 6000 * 4 / (2 * std::numbers::pi));
  EXPECT_DOUBLE_EQ(rig.encoders[4].counts_per_unit, 6000 * 4 / (2 * std::numbers::pi));
}

TEST(RigFile, HasARestAngleForSwingEncodersOnly) {
  ChangedTower tower;
  tower.change("[encoder.swing_radial]", "sign = 1", "sign = 1\nrest_angle_rad = -0.01");
  const Rig rig = parse_rig(tower.text(), "rig.toml");
  EXPECT_EQ(rig.encoders[plant::kSwingRadial].rest_angle_rad, -0.01);
  EXPECT_EQ(rig.encoders[plant::kSwingTangential].rest_angle_rad, 0);
  ChangedTower wrong;
  wrong.change("[encoder.trolley]", "sign = 1", "rest_angle_rad = 0.01")
      .change("[encoder.swing_tangential]", "sign = 1", "rest_angle_rad = 0.6");
  EXPECT_THAT(
      problems_of(wrong.text()),
      testing::UnorderedElementsAre(
          testing::HasSubstr("encoder.trolley.rest_angle_rad = 0.01: unknown key"),
          testing::HasSubstr("encoder.swing_tangential.rest_angle_rad = 0.6: must be in [-0.5, 0.5]")));
}

TEST(RigFile, CompensatesExactlyTheFrictionOfTheTower) {
  const Rig rig = load_rig(kTower);
  for (const auto& term : rig.terms) {
    const auto& nominal = rig.design.friction[term.axis == "trolley" ? plant::kTrolley : plant::kSlew];
    EXPECT_EQ(term.parameters.at("viscous_positive_vspm"), nominal.viscous_positive_vspm);
    EXPECT_EQ(term.parameters.at("viscous_negative_vspm"), nominal.viscous_negative_vspm);
    EXPECT_EQ(term.parameters.at("coulomb_positive_v"), nominal.coulomb_positive_v);
    EXPECT_EQ(term.parameters.at("coulomb_negative_v"), nominal.coulomb_negative_v);
    EXPECT_EQ(nominal.factor, 1.0);
  }
}

TEST(RigFile, GivesTheDesignThePlantParametersUnlessTheFileSaysOtherwise) {
  EXPECT_EQ(load_rig(kTower).design.crane.load_mass_kg, 2.0);
  const Rig rig = parse_rig(tower_text() + "\n[controller.believes]\nload_mass_kg = 1.0\n", "rig.toml");
  EXPECT_EQ(rig.design.crane.load_mass_kg, 1.0);
  EXPECT_EQ(rig.design.crane.trolley_inertia_kg, 22.46);
  EXPECT_EQ(rig.plant.load_mass_kg, 2.0);
}

TEST(RigFile, TakesMissingValuesFromTheExtendedFile) {
  const Rig ideal = load_rig(kRigs / "virginia_tech_tower_ideal.toml");
  EXPECT_THAT(ideal.terms, IsEmpty());
  EXPECT_EQ(ideal.design.friction[plant::kTrolley].factor, 0);
  EXPECT_EQ(ideal.plant.trolley_inertia_kg, 22.46);
  EXPECT_EQ(ideal.name, "virginia_tech_tower_ideal");
}

TEST(RigFile, ContainsThePlanningOfMoves) {
  const Rig tower = load_rig(kTower);
  EXPECT_FALSE(tower.planning.limits_jerk);
  EXPECT_EQ(tower.planning.shaping, control::Shaping::none);
  EXPECT_DOUBLE_EQ(tower.drives[0].reference_jerk, 10 * 0.9929);
  ChangedTower changed;
  changed.change("[controller]", "\"bang_coast_bang\"", "\"s_curve\"")
      .change("[controller]", "shaper = \"none\"", "shaper = \"ei\"")
      .change("[drive.slew]", "dac_channel = 1", "dac_channel = 1\nreference_jerk_radps3 = 7");
  const Rig rig = parse_rig(changed.text(), "rig.toml");
  EXPECT_TRUE(rig.planning.limits_jerk);
  EXPECT_EQ(rig.planning.shaping, control::Shaping::ei);
  EXPECT_EQ(rig.drives[1].reference_jerk, 7);
}

TEST(RigFile, GivesTheDesignItsAntiSwingGains) {
  ChangedTower changed;
  for (const auto& [from, to] :
       {std::pair{"delayed_2_gain = -0.33", "delayed_2_gain = -0.423"},
        std::pair{"delayed_2_delay = 0.31", "delayed_2_delay = 0.179"},
        std::pair{"anti_swing_proportional = -30.0", "anti_swing_proportional = -25.66"},
        std::pair{"anti_swing_derivative = 8.0", "anti_swing_derivative = 7.434"},
        std::pair{"fuzzy_gain = -90.0", "fuzzy_gain = -80"},
        std::pair{"fuzzy_swing_rad = 0.17453292519943295", "fuzzy_swing_rad = 0.2"},
        std::pair{"fuzzy_swing_rate = 1.5", "fuzzy_swing_rate = 1.25"},
        std::pair{"fuzzy_point_a = 0.3333333333333333", "fuzzy_point_a = 0.25"},
        std::pair{"fuzzy_point_b = 0.6666666666666666", "fuzzy_point_b = 0.75"}})
    changed.change("[controller]", from, to);
  const auto design = parse_rig(changed.text(), "rig.toml").design;
  EXPECT_EQ(design.delayed_2_gain, -0.423);
  EXPECT_EQ(design.delayed_2_delay, 0.179);
  EXPECT_EQ(design.anti_swing_proportional, -25.66);
  EXPECT_EQ(design.anti_swing_derivative, 7.434);
  EXPECT_EQ(design.fuzzy_gain, -80);
  EXPECT_EQ(design.fuzzy_swing_rad, 0.2);
  EXPECT_EQ(design.fuzzy_swing_rate, 1.25);
  EXPECT_EQ(design.fuzzy_point_a, 0.25);
  EXPECT_EQ(design.fuzzy_point_b, 0.75);
}

TEST(RigFile, StatesTheDefaultsOfTheDesign) {
  // The annotated example contains every gain; a file without gains gives the same rig.
  const auto written = load_rig(kTower).design;
  const control::Design defaults;
  EXPECT_EQ(written.delayed_2_gain, defaults.delayed_2_gain);
  EXPECT_EQ(written.anti_swing_proportional, defaults.anti_swing_proportional);
  EXPECT_EQ(written.fuzzy_swing_rad, defaults.fuzzy_swing_rad);
  EXPECT_EQ(written.fuzzy_point_a, defaults.fuzzy_point_a);
  EXPECT_EQ(written.fuzzy_point_b, defaults.fuzzy_point_b);
}

class RigFiles : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(RigFiles, LoadAndGiveADesignWithoutProblems) {
  const Rig rig = load_rig(GetParam());
  EXPECT_THAT(rig.plant.problems(), IsEmpty());
  EXPECT_THAT(control::problems(rig.design), IsEmpty());
  EXPECT_EQ(rig.name, GetParam().stem());
}

std::vector<std::filesystem::path> rig_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kRigs)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

INSTANTIATE_TEST_SUITE_P(Deployed, RigFiles, testing::ValuesIn(rig_files()),
                         [](const auto& entry) { return entry.param.stem().string(); });

TEST(RigFile, HasOnlyTheDrivesAndSensorsOfItsKind) {
  const auto present = [](const Rig& rig) {
    return std::vector<bool>{rig.drives[0].present, rig.drives[1].present, rig.drives[2].present};
  };
  EXPECT_THAT(present(load_rig(kRigs / "gantry.toml")), ElementsAre(true, false, true));
  EXPECT_THAT(present(load_rig(kRigs / "drive_axis.toml")), ElementsAre(true, false, false));
  EXPECT_THAT(present(load_rig(kRigs / "pendulum.toml")), ElementsAre(false, false, false));
  EXPECT_EQ(load_rig(kRigs / "drive_axis.toml").plant.load_mass_kg, 0);
  EXPECT_EQ(load_rig(kRigs / "gantry.toml").encoders[4].counts_per_unit, 0);
}

}  // namespace
}  // namespace crane::configuration
