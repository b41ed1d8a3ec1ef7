#include "crane/experiment/variant.hpp"

#include <gmock/gmock.h>

#include "crane/plant/term.hpp"
#include "rig.hpp"

namespace crane::experiment {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

configuration::Rig tower_with_friction() {
  configuration::Rig rig = tower();
  rig.terms = {{.name = "drive_friction", .axis = "trolley", .parameters = {}}};
  for (auto& friction : rig.design.friction) friction.factor = 1;
  rig.drives[plant::kSlew].reference_speed = 1;
  rig.drives[plant::kSlew].reference_acceleration = 2;
  return rig;
}

TEST(Variant, ComparesEightVariantsByDefault) {
  EXPECT_THAT(default_variants(),
              ElementsAre("ideal", "exact_compensation", "no_compensation", "under_compensation",
                          "short_cable", "long_cable", "light_load", "heavy_load"));
}

TEST(Variant, CompensatesOnlyTheDrivesThatHaveFriction) {
  const auto rig = changed_by(tower_with_friction(), "under_compensation");
  EXPECT_EQ(rig.design.friction[plant::kTrolley].factor, 0.8);
  EXPECT_EQ(rig.design.friction[plant::kSlew].factor, 0);
  EXPECT_EQ(changed_by(tower_with_friction(), "no_compensation").design.friction[0].factor, 0);
}

TEST(Variant, IdealHasNoEffectsAndNothingToCompensate) {
  const auto rig = changed_by(tower_with_friction(), "ideal");
  EXPECT_TRUE(rig.terms.empty());
  for (const auto& friction : rig.design.friction) EXPECT_EQ(friction.factor, 0);
}

TEST(Variant, ChangesTheTrueCableAndLoadAndNotTheDesignOfTheControllers) {
  const auto original = tower_with_friction();
  const auto longer = changed_by(original, "long_cable");
  EXPECT_DOUBLE_EQ(longer.start.cable_length_offset_m, 0.5);
  EXPECT_EQ(longer.start.position, original.start.position);
  EXPECT_EQ(longer.design.cable_length_m, original.design.cable_length_m);
  EXPECT_DOUBLE_EQ(changed_by(original, "short_cable").start.cable_length_offset_m, -0.5);
  const auto heavier = changed_by(original, "heavy_load");
  EXPECT_DOUBLE_EQ(heavier.plant.load_mass_kg, 3);
  EXPECT_DOUBLE_EQ(heavier.design.crane.load_mass_kg, 2);
  EXPECT_DOUBLE_EQ(changed_by(original, "heavy_load+known_load").design.crane.load_mass_kg, 3);
}

TEST(Variant, GustsBlowOnTheSimulatedCraneOnly) {
  const auto original = tower_with_friction();
  const auto windy = changed_by(original, "gusts_across");
  ASSERT_EQ(windy.terms.size(), original.terms.size() + 1);
  EXPECT_EQ(windy.terms.back().name, "wind_gust");
  EXPECT_TRUE(plant::problems(windy.terms).empty());
  EXPECT_EQ(windy.design, original.design);
}

TEST(Variant, ChangesTheTrueFrictionAndNotItsCompensation) {
  auto original = tower_with_friction();
  original.terms.front().parameters = {
      {"coulomb_positive_v", 1}, {"viscous_positive_vspm", 2}, {"smoothing_speed", 3}};
  const auto rig = changed_by(original, "friction_plus_20");
  const auto& changed = rig.terms.front().parameters;
  EXPECT_DOUBLE_EQ(changed.at("coulomb_positive_v"), 1.2);
  EXPECT_DOUBLE_EQ(changed.at("viscous_positive_vspm"), 2.4);
  EXPECT_EQ(changed.at("smoothing_speed"), 3);
  EXPECT_EQ(rig.design.friction, original.design.friction);
  EXPECT_DOUBLE_EQ(
      changed_by(original, "friction_minus_20").terms.front().parameters.at("coulomb_positive_v"), 0.8);
}

TEST(Variant, PartsAreAppliedFromLeftToRight) {
  const auto rig = changed_by(tower_with_friction(), "long_cable+known_cable+slow_reference+no_compensation");
  EXPECT_DOUBLE_EQ(rig.start.position[plant::kHoist], 1.5);
  EXPECT_EQ(rig.start.cable_length_offset_m, 0);
  EXPECT_EQ(rig.drives[plant::kSlew].reference_speed, 0.5);  // V/2, a/4: (4.22)
  EXPECT_EQ(rig.drives[plant::kSlew].reference_acceleration, 0.5);
  EXPECT_EQ(rig.design.friction[0].factor, 0);
  EXPECT_EQ(changed_by(tower_with_friction(), "known_cable+long_cable").start.cable_length_offset_m, 0.5);
}

TEST(Variant, RefusesUnknownNamesAndListsTheKnownNames) {
  EXPECT_THAT(variant_problems("ideal+windy+stormy"),
              ElementsAre(HasSubstr("variant \"windy\": must be one of ideal, "), HasSubstr("stormy")));
  EXPECT_EQ(variant_problems("ideal+").size(), 1U);
  EXPECT_THROW((void)changed_by(tower(), "windy"), configuration::ConfigurationError);
  EXPECT_EQ(changed_by(tower(), "").name, tower().name);
}

}  // namespace
}  // namespace crane::experiment
