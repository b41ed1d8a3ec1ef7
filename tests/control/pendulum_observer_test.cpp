/// Compares the pendulum observer with the nonlinear equations of the tower.
#include "crane/control/pendulum_observer.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "planned_crane.hpp"

namespace crane::control {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Measurement encoders(const plant::State& s, const Volts& acting, double offset_rad) {
  Measurement m;
  m.position = {counted(s.trolley_m, 629921.26), counted(s.slew_rad, 57295.78), s.cable_m};
  m.swing_radial_rad = counted(s.radial_rad + offset_rad, 3819.7186);
  m.swing_tangential_rad = counted(s.tangential_rad, 3819.7186);
  m.applied_v = acting;
  return m;
}

/// Runs the crane with volts for both axes. @return largest errors of the predictions after `begin_s`
struct Errors {
  double swing_rad = 0, rate_radps = 0, speed = 0;
};
Errors follow(TestCrane crane, double offset_rad, double begin_s, CraneEstimate* last = nullptr) {
  PendulumObserver observer{crane.design};
  plant::State s;
  s.trolley_m = 0.6, s.cable_m = crane.cable_ratio, s.radial_rad = 5 * kDegree;
  Errors worst;
  for (int k = 0; k < 1000; ++k) {
    const double t = k * crane.design.period_s;
    // Without friction the speed does not decay: the volts have zero mean, so that the trolley stays on the
    // jib.
    const bool rubs = crane.friction[kTrolley].factor > 0;
    const Volts volts = rubs ? Volts{3 * std::sin(2.5 * t), 2.5 * std::sin(1.9 * t), 0}
                             : Volts{0.4 * std::cos(1.2 * t), 0.2 * std::cos(1.2 * t), 0};
    const CraneEstimate& ahead = observer.step(encoders(s, volts, offset_rad));
    s = after_tick(crane, s, volts);
    if (t >= begin_s) {
      worst.swing_rad = std::max(worst.swing_rad, std::abs(ahead.state.radial_rad - s.radial_rad));
      worst.rate_radps =
          std::max(worst.rate_radps, std::abs(ahead.state.tangential_radps - s.tangential_radps));
      worst.speed = std::max(worst.speed, std::abs(ahead.state.trolley_mps - s.trolley_mps));
    }
    if (last != nullptr) *last = ahead;
  }
  return worst;
}

TEST(PendulumObserver, PredictsSwingRateAndSpeedOfTheNextTickWithoutFriction) {
  const Errors worst = follow(TestCrane{}, 0, 1);
  EXPECT_LT(worst.swing_rad, 0.03 * kDegree);  // two counts of the encoder
  EXPECT_LT(worst.rate_radps, 0.01);           // two counts per tick, differentiated, are 0.05
  EXPECT_LT(worst.speed, 0.001);
}

TEST(PendulumObserver, PredictsWithKnownFrictionAndWithAWrongCableLength) {
  EXPECT_LT(follow(tower_with_friction(), 0, 1).swing_rad, 0.1 * kDegree);
  TestCrane crane = tower_with_friction();
  crane.cable_ratio = 1.2;
  EXPECT_LT(follow(crane, 0, 1).swing_rad, 0.2 * kDegree);
}

TEST(PendulumObserver, FindsTheOffsetOfAnEncoder) {
  CraneEstimate last;
  (void)follow(TestCrane{}, 1 * kDegree, 5, &last);
  EXPECT_NEAR(last.radial.offset_rad + last.radial.force_rad, 1 * kDegree, 0.1 * kDegree);
  EXPECT_NEAR(last.tangential.offset_rad + last.tangential.force_rad, 0, 0.1 * kDegree);
}

TEST(PendulumObserver, KeepsItsEstimateWhenAMeasurementIsNotANumber) {
  PendulumObserver observer{Design{}};
  Measurement m;
  m.position = {0.5, 0, 1};
  const plant::State before = observer.step(m).state;
  m.swing_radial_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(observer.step(m).state, before);
}

TEST(ObservedLaw, GivesZeroVoltsAtRestOnItsReferenceAndPassesOnNaN) {
  Measurement m;
  m.position = {0.7, 0.3, 1.2};
  Reference r;
  for (std::size_t axis = 0; axis < kAxes; ++axis) r[axis].position = m.position[axis];
  for (const auto& controller : controllers()) {
    const auto law = with_observer(controller.make_tracking(Design{}), Design{});
    law->reset(m);
    for (const double v : law->step(m, r).drive_v) EXPECT_EQ(v, 0) << controller.name;
    Measurement broken = m;
    broken.position[kTrolley] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(std::isfinite(law->step(broken, r).drive_v[kTrolley])) << controller.name;
    EXPECT_TRUE(std::isfinite(law->step(m, r).drive_v[kTrolley])) << controller.name;
  }
}

}  // namespace
}  // namespace crane::control
