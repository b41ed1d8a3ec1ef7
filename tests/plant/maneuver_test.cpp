/// Partial gain scheduling with the full model without friction settles at the recomputed times.
#include <gtest/gtest.h>

#include "closed_loop.hpp"
#include "crane/simulator/integrator.hpp"

namespace crane::simulator {
namespace {

struct Result {
  double settling_s = 0;
  double largest_radial_deg = 0, largest_tangential_deg = 0;
};

Result run(const test::Maneuver& maneuver) {
  const plant::Parameters crane;
  const plant::Model model{crane};
  Integrator integrator{model};
  plant::State s{.trolley_m = maneuver.start_trolley_m};
  Result result;
  constexpr double kDegree = std::numbers::pi / 180;
  for (int tick = 1; tick <= 2000; ++tick) {
    integrator.advance(s, test::driven(test::partial_gain_scheduling(crane, s, maneuver)), test::kTick_s);
    if (!test::settled(s, maneuver)) result.settling_s = (tick + 1) * test::kTick_s;
    result.largest_radial_deg = std::max(result.largest_radial_deg, std::abs(s.radial_rad) / kDegree);
    result.largest_tangential_deg =
        std::max(result.largest_tangential_deg, std::abs(s.tangential_rad) / kDegree);
  }
  return result;
}

constexpr double kTwoTicks_s = 0.02;
constexpr double kPrinted_deg = 0.06;  // tables give one decimal

TEST(Maneuvers, FirstOneSettlesAsTabulated) {
  const Result r = run(test::kManeuver1);
  EXPECT_NEAR(r.settling_s, 3.38, kTwoTicks_s);
  EXPECT_NEAR(r.largest_radial_deg, 5.6, kPrinted_deg);
  EXPECT_EQ(r.largest_tangential_deg, 0);
}

TEST(Maneuvers, SecondOneSettlesAsTabulated) {
  const Result r = run(test::kManeuver2);
  EXPECT_NEAR(r.settling_s, 4.61, kTwoTicks_s);
  EXPECT_NEAR(r.largest_radial_deg, 5.3, kPrinted_deg);
  EXPECT_NEAR(r.largest_tangential_deg, 10.5, kPrinted_deg);
}

TEST(Maneuvers, ThirdOneSettlesAsTabulated) {
  const Result r = run(test::kManeuver3);
  EXPECT_NEAR(r.settling_s, 4.82, kTwoTicks_s);
  EXPECT_NEAR(r.largest_radial_deg, 6.0, kPrinted_deg);
  EXPECT_NEAR(r.largest_tangential_deg, 3.6, kPrinted_deg);
}

}  // namespace
}  // namespace crane::simulator
