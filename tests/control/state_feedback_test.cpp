#include "crane/control/state_feedback.hpp"

#include <gtest/gtest.h>

#include "crane/control/gain_scheduling.hpp"

namespace crane::control {
namespace {

/// The law V = k_p (r - q) - k_v q' - k_s s - k_r s' with the gains of (3.19) at one operating point.
StateFeedbackGains gains_of(const Design& design, const Schedule& at) {
  const auto [trolley, slew] = partial_state_gains(design, at);
  const auto axis = [](const Gains& k, double sign) {
    return StateFeedbackAxis{k.position, k.position * k.speed, sign * k.position * k.swing,
                             sign * k.position * k.swing_rate};
  };
  return {axis(trolley, 1), axis(slew, -1)};
}

TEST(StateFeedback, EqualsGainSchedulingAtTheOperatingPointOfItsGains) {
  const Design design;
  Measurement measured;
  measured.position = {0.8, 0.4, 1.0};
  measured.speed = {0.2, -0.3, 0};
  measured.swing_radial_rad = 0.05;
  measured.swing_radial_radps = -0.2;
  measured.swing_tangential_rad = -0.03;
  measured.swing_tangential_radps = 0.1;
  Reference reference;
  reference[kTrolley].position = 1.1;
  reference[kSlew].position = 0.1;
  reference[kHoist].position = 1.0;
  const auto gains = gains_of(design, schedule(design, measured));
  const auto tracking = make_state_feedback_tracking(design, gains)->step(measured, reference);
  const auto anti_swing = make_state_feedback_anti_swing(design, gains)->step(measured, reference);
  const auto expected_tracking = make_partial_tracking(design)->step(measured, reference);
  const auto expected_anti_swing = make_partial_anti_swing(design)->step(measured, reference);
  for (const auto axis : {kTrolley, kSlew, kHoist}) {
    EXPECT_NEAR(tracking.drive_v[axis], expected_tracking.drive_v[axis], 1e-12);
    EXPECT_NEAR(anti_swing.drive_v[axis], expected_anti_swing.drive_v[axis], 1e-12);
  }
}

TEST(StateFeedback, GivesZeroVoltsAtRestOnItsReference) {
  const Design design;
  Measurement measured;
  measured.position = {0.8, 0.4, 1.0};
  Reference reference;
  for (std::size_t i = 0; i < kAxes; ++i) reference[i].position = measured.position[i];
  const StateFeedbackGains gains{{4, 5, 15, -0.2}, {4, 6, -16, -3}};
  EXPECT_EQ(make_state_feedback_tracking(design, gains)->step(measured, reference).drive_v, Volts{});
  EXPECT_EQ(make_state_feedback_anti_swing(design, gains)->step(measured, reference).drive_v, Volts{});
}

}  // namespace
}  // namespace crane::control
