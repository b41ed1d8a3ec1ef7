/// The table of units, and the nearest known name.
#include "crane/fields/unit.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "crane/fields/nearest_name.hpp"

namespace crane::fields {
namespace {

TEST(Units, HaveDifferentSymbolsAndSuffixes) {
  std::set<std::string_view> symbols, suffixes;
  for (const auto& unit : units()) {
    EXPECT_TRUE(symbols.insert(unit.symbol).second) << unit.symbol;
    EXPECT_TRUE(suffixes.insert(unit.suffix).second) << unit.suffix;
    EXPECT_GT(unit.factor, 0) << unit.symbol;
  }
}

TEST(Units, FirstOfEveryDimensionIsTheSiUnit) {
  for (const auto& unit : units())
    EXPECT_EQ(unit_with_symbol(text_of(unit.dimension))->factor, 1) << unit.symbol;
}

TEST(Units, AreThoseOfTheNames) {
  EXPECT_EQ(unit_of_name("trolley_speed_mps")->symbol, "m/s");
  EXPECT_EQ(unit_of_name("swing_radial_rad")->symbol, "rad");
  EXPECT_EQ(unit_of_name("step_max_us")->factor, 1e-6);
  EXPECT_EQ(unit_of_name("applied_v")->symbol, "V");
  EXPECT_EQ(unit_of_name("tick"), nullptr);
  EXPECT_EQ(unit_of_name("lost_ticks"), nullptr);
  EXPECT_DOUBLE_EQ(unit_with_symbol("deg")->factor, std::numbers::pi / 180);
}

TEST(Units, ProductsAndQuotientsHaveTheirDimension) {
  const auto metre = unit_with_symbol("m")->dimension, second = unit_with_symbol("s")->dimension;
  EXPECT_EQ(metre / second, unit_with_symbol("m/s")->dimension);
  EXPECT_EQ(metre / second * second, metre);
  EXPECT_EQ(text_of(metre * metre), "m^2");
  EXPECT_EQ(text_of(metre / metre), "1");
  EXPECT_EQ(symbols_of(metre), "m, cm, mm");
}

TEST(NearestName, IsTheOneWithTheFewestChanges) {
  const std::vector<std::string> known{"swing_radial_rad", "swing_radial_radps", "slew_angle_rad"};
  EXPECT_EQ(nearest_name("swing_radial_ra", known), "swing_radial_rad");
  EXPECT_EQ(nearest_name("slew_angel_rad", known), "slew_angle_rad");
  EXPECT_EQ(nearest_name("xyz", known), "");
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

}  // namespace
}  // namespace crane::fields
