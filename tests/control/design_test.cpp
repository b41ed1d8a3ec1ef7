#include <gmock/gmock.h>

#include <limits>

#include "crane/control/law.hpp"

namespace crane::control {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(Design, IsValidByDefault) { EXPECT_THAT(problems(Design{}), IsEmpty()); }

TEST(Design, ReportsEveryProblemByNameValueAndRule) {
  Design design;
  design.period_s = 0;
  design.delayed_1_delay = std::numeric_limits<double>::quiet_NaN();
  design.volt_limit_v[kSlew] = -1;
  design.friction[kTrolley].zero_band_mps = 0;
  design.friction[kHoist].factor = 1.6;
  EXPECT_THAT(problems(design),
              ElementsAre("period_s = 0: must be in [1e-05, 0.1]", "delayed_1_delay = nan: must be in [0, 2]",
                          "friction.trolley.zero_band = 0: must be in (0, 1]",
                          "volt_limit_v.slew = -1: must be in (0, 10]",
                          "friction.hoist.factor = 1.6: must be in [0, 1.5]"));
}

TEST(Design, RequiresACableLengthBetweenShortestAndLongest) {
  Design design;
  design.cable_length_m = 0.05;
  EXPECT_THAT(problems(design), ElementsAre("cable_length_m = 0.05: must be in [0.1, 100]"));
  design = {};
  design.longest_cable_length_m = 0.05;
  EXPECT_THAT(problems(design), Contains("longest_cable_length_m = 0.05: must be in "
                                         "[shortest_cable_length_m, 1000]"));
}

TEST(Design, RequiresDistinctMembershipPoints) {
  Design design;
  design.fuzzy_point_a = 0.7;
  EXPECT_THAT(problems(design),
              ElementsAre("fuzzy_point_b = 0.666667: must be at least fuzzy_point_a + 0.01"));
}

TEST(Design, RefusesFrictionThatHoldsADriveAtFullVoltage) {
  Design design;
  design.friction[kSlew].stiction_negative_v = 8;
  design.friction[kSlew].factor = 1.5;
  EXPECT_THAT(problems(design),
              ElementsAre("friction.slew.stiction_negative_v = 8: the value times factor must be below "
                          "the volt_limit_v of the drive"));
  design.friction[kSlew].factor = 1;
  EXPECT_THAT(problems(design), IsEmpty());
}

TEST(Design, RefusesInvalidLengthsPeriodsAndLoads) {
  const auto only = [](auto&& change) {
    Design design;
    change(design);
    const auto found = problems(design);
    return found.empty() ? std::string() : found.front();
  };
  EXPECT_EQ(only([](Design& d) { d.shortest_cable_length_m = 0; }),
            "shortest_cable_length_m = 0: must be in [0.001, 1000]");
  EXPECT_EQ(only([](Design& d) { d.shortest_cable_length_m = -1; }),
            "shortest_cable_length_m = -1: must be in [0.001, 1000]");
  EXPECT_EQ(only([](Design& d) { d.period_s = -0.01; }), "period_s = -0.01: must be in [1e-05, 0.1]");
  EXPECT_NE(only([](Design& d) { d.crane.load_mass_kg = -2; }).find("load_mass_kg = -2"), std::string::npos);
  EXPECT_NE(only([](Design& d) { d.crane.gravity_mps2 = 0; }).find("gravity_mps2 = 0"), std::string::npos);
}

TEST(Design, IncludesTheProblemsOfItsCrane) {
  Design design;
  design.crane.gravity_mps2 = -1;
  EXPECT_EQ(problems(design).size(), 1u);
}

TEST(DriveFriction, ReportsEveryProblem) {
  DriveFriction friction;
  friction.coulomb_negative_v = -1;
  friction.stiction_slope_per_v = 0;
  EXPECT_THAT(friction.problems(), ElementsAre("coulomb_negative_v = -1: must be in [0, 1000]",
                                               "stiction_slope_per_v = 0: must be in (0, 1e+06]"));
}

}  // namespace
}  // namespace crane::control
