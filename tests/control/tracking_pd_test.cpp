#include "crane/control/tracking_pd.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "crane/control/schedule.hpp"
#include "linear_model.hpp"

namespace crane::control {
namespace {

TEST(TrackingPd, IsCriticallyDampedOnBothAxesForAnyCableAndLoad) {
  for (const double length : {0.5, 1.0, 4.0})
    for (const double load : {0.0, 2.0, 20.0})
      for (const double x : {0.05, 0.4, 1.2}) {
        Design design;
        design.cable_length_m = length;
        design.crane.load_mass_kg = load;
        const double w0 = std::sqrt(design.crane.gravity_mps2 / length);
        const double period_s = 2 * std::numbers::pi / w0;
        for (const Motion motion : {Motion::trolley, Motion::slew}) {
          // K_p = 100: double pole at -sqrt(K_p) per period; the load swings freely.
          const auto mismatch = worst_mismatch(closed_loop(*find_controller("none"), design, motion, x),
                                               {{0, w0}, {0, -w0}, -10 / period_s, -10 / period_s});
          EXPECT_LT(mismatch, 1e-6 * 10 / period_s) << "L " << length << " m " << load << " x " << x;
        }
      }
}

TEST(TrackingPd, FollowsTheReferenceSpeed) {
  const Design design;
  const auto law = make_tracking_pd(design);
  Measurement m;
  m.position = {0.5, 0, 1};
  m.speed = {0.3, 0.2, 0.01};
  Reference r;
  r[kTrolley] = {0.5, 0.3, 0};
  r[kSlew] = {0, 0.2, 0};
  r[kHoist] = {1, 0.01, 0};
  const Volts v = law->step(m, r).drive_v;
  EXPECT_NEAR(v[kTrolley], 0, 1e-12);
  EXPECT_NEAR(v[kSlew], 0, 1e-12);
  EXPECT_NEAR(v[kHoist], 0.01 / design.crane.hoist_gain_mpspv, 1e-12);
}

TEST(TrackingPd, MatchesEquation338WrittenInY) {
  const Design design;
  const auto& c = design.crane;
  Measurement m;
  m.position = {0.8, 0.1, 1.3};
  m.speed = {0, -0.2, 0};
  m.swing_tangential_rad = 0.07;
  Reference r;
  r[kSlew] = {0.6, 0.5, 0};
  const double length = 1.3, x = 0.8;
  const double period_s = 2 * std::numbers::pi * std::sqrt(length / c.gravity_mps2);
  const double e_y = -(x / length) * (0.6 - 0.1), e_y_rate = -(x / length) * (0.5 + 0.2);
  const double vbar_y = 100 * e_y + period_s * 20 * e_y_rate;
  const double expected =
      (-length * (1 + c.trolley_to_jib_ratio() * x * x) / (x * period_s * period_s) * vbar_y -
       c.load_to_jib_ratio() * c.gravity_mps2 * x * 0.07) /
      c.slew_gain_radps2pv;
  EXPECT_NEAR(make_tracking_pd(design)->step(m, r).drive_v[kSlew], expected, 1e-12 * std::abs(expected));
}

TEST(HoistLaw, BringsTheCableToItsReferenceFirstOrder) {
  // Speed-controlled drive: L' = hoist_gain V, so the error decays with rate K_h for every tracking.
  const Design design;
  for (const auto& controller : controllers()) {
    const auto law = controller.make_tracking(design);
    Measurement m;
    m.position = {0.5, 0, 1.0};
    Reference r;
    r[kHoist].position = 0.6;
    const double speed = design.crane.hoist_gain_mpspv * law->step(m, r).drive_v[kHoist];
    EXPECT_NEAR(speed, -0.4 * design.hoist_proportional_ps, 1e-12) << controller.name;
    EXPECT_EQ(controller.make_anti_swing(design)->step(m, r).drive_v[kHoist], 0) << controller.name;
  }
}

TEST(NoAntiSwing, ContributesNothing) {
  Measurement m;
  m.position = {0.5, 0, 1};
  m.swing_radial_rad = 0.3;
  m.swing_tangential_rad = 0.3;
  EXPECT_EQ(make_no_anti_swing(Design{})->step(m, {}).drive_v, Volts{});
}

}  // namespace
}  // namespace crane::control
