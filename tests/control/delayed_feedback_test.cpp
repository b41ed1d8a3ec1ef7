#include "crane/control/delayed_feedback.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "crane/control/delay_line.hpp"

namespace crane::control {
namespace {

using std::numbers::pi;

TEST(DelayLine, IsExactOnRampsAtFractionalDelays) {
  DelayLine line(20);
  line.reset(0);
  for (int k = 0; k < 100; ++k) line.push(0.5 * k);
  for (const double delay : {0.0, 0.25, 7.0, 13.9, 20.0})
    EXPECT_NEAR(line.at(delay), 0.5 * (99 - delay), 1e-12) << delay;
  EXPECT_NEAR(line.at(1e9), 0.5 * 79, 1e-12) << "longer delays read the oldest sample";
  EXPECT_NEAR(line.at(-1), 0.5 * 99, 1e-12) << "a negative delay reads the newest sample";
}

TEST(Delayed1, ReactsToTheSwingOfTauPeriodsAgo) {
  const Design design;
  const auto law = make_delayed_1(design);
  Measurement m;
  m.position = {0.8, 0, 1.0};
  law->reset(m);
  const double rate = 0.2;  // rad/s, so that linear interpolation is exact
  Volts v{};
  for (int k = 0; k <= 100; ++k) {
    m.swing_radial_rad = rate * k * design.period_s;
    m.swing_tangential_rad = -2 * m.swing_radial_rad;
    v = law->step(m, {}).drive_v;
  }
  const auto& c = design.crane;
  const double period_s = 2 * pi * std::sqrt(1.0 / c.gravity_mps2);
  const double seen = rate * (1.0 - 0.1 * period_s);
  EXPECT_NEAR(v[kTrolley], -90 * seen / (period_s * period_s * c.trolley_gain_mps2pv), 1e-12);
  const double inertia = 1 + c.trolley_to_jib_ratio() * 0.8 * 0.8;
  EXPECT_NEAR(v[kSlew], -inertia / (0.8 * period_s * period_s * c.slew_gain_radps2pv) * -90 * -2 * seen,
              1e-12);
}

TEST(Delayed1, StartsFromRestAsMeasuredAfterReset) {
  const auto law = make_delayed_1(Design{});
  Measurement m;
  m.position = {0.8, 0, 1.0};
  m.swing_radial_rad = 0.1;
  law->reset(m);
  const Volts first = law->step(m, {}).drive_v;
  for (int k = 0; k < 50; ++k) EXPECT_NEAR(law->step(m, {}).drive_v[kTrolley], first[kTrolley], 1e-15);
  EXPECT_NE(first[kTrolley], 0);
}

TEST(Delayed2, CorrectsTheReferenceByTheSwingOfTauPeriodsAgo) {
  const Design design;
  const auto law = make_delayed_2(design);
  Measurement m;
  m.position = {0.8, 0, 1.5};
  law->reset(m);
  const double rate = 0.2;
  Contribution last;
  for (int k = 0; k <= 200; ++k) {
    m.swing_radial_rad = rate * k * design.period_s;
    m.swing_tangential_rad = -2 * m.swing_radial_rad;
    m.swing_radial_radps = rate;
    m.swing_tangential_radps = -2 * rate;
    last = law->step(m, {});
  }
  const double seen = rate * (2.0 - 0.31 * 2 * pi * std::sqrt(1.5 / design.crane.gravity_mps2));
  EXPECT_EQ(last.drive_v, Volts{});
  EXPECT_NEAR(last.correction[kTrolley].position, 1.5 * -0.33 * seen, 1e-12);
  EXPECT_NEAR(last.correction[kTrolley].speed, 1.5 * -0.33 * rate, 1e-12);
  EXPECT_NEAR(last.correction[kSlew].position, -1.5 / 0.8 * -0.33 * -2 * seen, 1e-12);
  EXPECT_NEAR(last.correction[kSlew].speed, -1.5 / 0.8 * -0.33 * -2 * rate, 1e-12);
}

}  // namespace
}  // namespace crane::control
