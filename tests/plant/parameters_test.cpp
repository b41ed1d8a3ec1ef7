#include "crane/plant/parameters.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "crane/plant/model.hpp"

namespace crane::plant {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Parameters, OfTheDissertationsRigAreUsable) { EXPECT_TRUE(Parameters{}.problems().empty()); }

TEST(Parameters, ReportEveryProblemAtOnceWithNameValueAndRule) {
  Parameters p;
  p.gravity_mps2 = 0;
  p.load_mass_kg = -1;
  p.hoist_lag_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(p.problems(),
              ElementsAre("gravity_mps2 = 0: must be in [0.001, 100]",
                          "load_mass_kg = -1: must be in [0, 1e+06]", HasSubstr("hoist_lag_s = nan")));
  EXPECT_THROW(Model{p}, std::invalid_argument);
}

TEST(Parameters, AllowNoLoadAndAMasslessTrolley) {
  Parameters p;
  p.load_mass_kg = p.trolley_mass_kg = 0;
  EXPECT_TRUE(p.problems().empty());
}

}  // namespace
}  // namespace crane::plant
