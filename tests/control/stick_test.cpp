/// The stick law: limits under hostile histories, and the residual swing after a release. The load is the
/// pendulum of space_pendulum.hpp.
#include "crane/control/stick.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "crane/plant/pendulum.hpp"
#include "space_pendulum.hpp"
#include "stick_history.hpp"

namespace crane::control {
namespace {

using test::RandomStick;
using test::SpacePendulum;
using test::speeds;
using test::tower_stick;
using Wanted = std::array<double, kAxes>;

constexpr double kDegree = std::numbers::pi / 180;

Reference rest_at(double trolley_m, double slew_rad, double cable_m) {
  Reference reference;
  reference[kTrolley].position = trolley_m;
  reference[kSlew].position = slew_rad;
  reference[kHoist].position = cable_m;
  return reference;
}

/// A stick with its reference and a load.
struct Crane {
  explicit Crane(StickLimits stick_limits, const Reference& start = rest_at(1, 0, 1))
      : limits{std::move(stick_limits)}, at{start} {
    begin(limits, start, memory);
  }
  void tick(const Wanted& wanted) {
    const Reference next = step(limits, wanted, memory);
    load.step(at, next, limits.period_s);
    at = next;
  }
  /// @return seconds until nothing moves
  double release() {
    double time_s = 0;
    for (; !at_rest(memory); time_s += limits.period_s) tick({});
    return time_s;
  }
  StickLimits limits;
  StickMemory memory;
  Reference at;
  SpacePendulum load;
};

TEST(Stick, ReachesTheWantedSpeedInHalfAPeriodAndARamp) {
  Crane crane{tower_stick(Shaping::zv, {true, false, false})};
  const double wanted_mps = 0.3, half_s = plant::swing_period_s(9.81, 1) / 2;
  const double ramp_s = wanted_mps / (2 * crane.limits.axis[kTrolley].acceleration);
  double time_s = 0;
  for (; crane.at[kTrolley].speed < wanted_mps - 1e-9; time_s += 0.01) crane.tick({wanted_mps, 0, 0});
  constexpr double kPath_s = 0.02, kTick_s = 0.01;  // delay of the reference; the period in whole ticks
  EXPECT_NEAR(time_s, half_s + ramp_s + kPath_s, 3 * kTick_s);
}

struct Motions {
  std::array<bool, kAxes> used;
  double most_rad;  ///< largest permitted residual swing
};

class EveryMotion : public testing::TestWithParam<Motions> {};

/// The residual swing is zero for small angles and L'' = 0. It is not zero at large angles (20 degrees),
/// which have a longer period, and with L'', which the equation of the path neglects.
TEST_P(EveryMotion, LeavesTheLoadAtRestAfterEveryHistory) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Crane crane{tower_stick(Shaping::zv, GetParam().used)};
    RandomStick stick{seed, GetParam().used, 0.1 + 0.03 * seed};
    for (int k = 0; k < 1000; ++k) crane.tick(speeds(crane.limits, stick.next(0.01)));
    crane.release();
    EXPECT_LT(crane.load.residual_rad(), GetParam().most_rad) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Stick, EveryMotion,
                         testing::Values(Motions{{true, false, false}, 0.25 * kDegree},
                                         Motions{{false, true, false}, 0.1 * kDegree},
                                         Motions{{true, true, false}, 0.25 * kDegree},
                                         Motions{{true, false, true}, 1.2 * kDegree},
                                         Motions{{true, true, true}, 1.5 * kDegree}));

TEST(Stick, PlansTheSwingOfTheLoad) {
  const std::array<bool, kAxes> used{true, true, false};
  Crane crane{tower_stick(Shaping::zv, used)};
  RandomStick stick{7, used, 1.0};
  double planned_radial_rad = 0, planned_tangential_rad = 0;  // for the tick after the reference
  for (int k = 0; k < 800; ++k) {
    crane.tick(speeds(crane.limits, stick.next(0.01)));
    ASSERT_NEAR(planned_radial_rad, crane.load.radial_rad(), 0.1 * kDegree) << "tick " << k;
    ASSERT_NEAR(planned_tangential_rad, crane.load.tangential_rad(), 0.1 * kDegree) << "tick " << k;
    planned_radial_rad = crane.at.swing.radial_rad;
    planned_tangential_rad = crane.at.swing.tangential_rad;
  }
}

/// Seeds, with a period of change from one tick to seconds.
class HostileStick : public testing::TestWithParam<Shaping> {};

TEST_P(HostileStick, NeverLeavesTheLimitsOfPositionSpeedAndAcceleration) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    Crane crane{tower_stick(GetParam()), rest_at(1.7, 2.7, 1.2)};
    RandomStick stick{seed, {true, true, true}, 0.02 + 0.03 * seed};
    for (int k = 0; k < 1500; ++k) {
      crane.tick(speeds(crane.limits, stick.next(0.01)));
      for (std::size_t i = 0; i < kAxes; ++i) {
        const auto& axis = crane.limits.axis[i];
        const auto& at = crane.at[i];
        ASSERT_GE(at.position, axis.low) << "axis " << i << " seed " << seed << " tick " << k;
        ASSERT_LE(at.position, axis.high) << "axis " << i << " seed " << seed << " tick " << k;
        ASSERT_LE(std::abs(at.speed), axis.speed + 1e-9) << "axis " << i << " seed " << seed;
        ASSERT_LE(std::abs(at.acceleration), axis.acceleration + 1e-9) << "axis " << i << " seed " << seed;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryShaper, HostileStick,
                         testing::Values(Shaping::none, Shaping::zv, Shaping::zvd));

TEST(Stick, StopsAtTheLimitWhenTheStickStaysDeflected) {
  Crane crane{tower_stick()};
  for (int k = 0; k < 3000; ++k) crane.tick({9, -9, 9});
  EXPECT_NEAR(crane.at[kTrolley].position, 1.86, 0.045) << "the circle of the load is 2 % inside";
  EXPECT_NEAR(crane.at[kSlew].position, -3, 0.06) << "the load turns 0.05 rad inside";
  EXPECT_NEAR(crane.at[kHoist].position, 1.5, 0.01);
}

TEST(Stick, LeavesAPositionOutsideTheLimitsInwardsOnly) {
  Crane crane{tower_stick(), rest_at(1.95, 0, 1)};
  for (int k = 0; k < 300; ++k) crane.tick({0.4, 0, 0});
  EXPECT_EQ(crane.at[kTrolley].position, 1.95);
  for (int k = 0; k < 500; ++k) crane.tick({-0.4, 0, 0});
  EXPECT_LT(crane.at[kTrolley].position, 1.8);
}

TEST(Stick, TakesNaNAsRelease) {
  for (const double none :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Crane crane{tower_stick()};
    for (int k = 0; k < 50; ++k) crane.tick({none, -none, none});
    EXPECT_EQ(crane.at[kTrolley].position, 1) << none;
    EXPECT_TRUE(at_rest(crane.memory)) << none;
  }
}

TEST(Stick, NamesEveryProblemOfItsLimits) {
  StickLimits limits = tower_stick();
  limits.period_s = 0;
  limits.axis[kTrolley].acceleration = 0;
  EXPECT_EQ(problems(limits).size(), 3u) << "period, ticks of the swing period, acceleration";
  EXPECT_TRUE(problems(tower_stick()).empty());
}

}  // namespace
}  // namespace crane::control
