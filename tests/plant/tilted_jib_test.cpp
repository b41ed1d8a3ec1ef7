/// A jib out of the horizontal on a vertical slew axis: simulator against Newton's law for the load as a
/// point mass in the ground frame, with the cable as a constraint. The second computation shares no equation
/// with the plant: no angles, no mass matrix.
#include <gtest/gtest.h>

#include <cmath>

#include "crane/simulator/integrator.hpp"
#include "point_mass_crane.hpp"

namespace crane::simulator {
namespace {

using plant::Model;
using plant::State;

constexpr double kTilt_rad = 0.05, kCable_m = 0.9;

/// Volts of trolley and slew.
plant::PerAxis command_v(double t) {
  return {0.8 * std::cos(1.7 * t) + 0.4 * std::cos(3.1 * t),
          0.6 * std::cos(0.9 * t) + 0.5 * std::cos(2.3 * t), 0};
}

Model tilted(double angle_rad) { return Model{{}, {{"jib_tilt", "", {{"angle_rad", angle_rad}}}}}; }

/// Largest difference of trolley, slew and both swings in 10 s.
double largest_difference(double simulated_rad, double true_rad, Method method = Method::cvode) {
  const Model model = tilted(simulated_rad);
  Integrator integrator{model, {.relative = 1e-10, .absolute = 1e-10}, method};
  State s{.trolley_m = 0.6, .radial_rad = true_rad, .cable_m = kCable_m};
  test::PointMassCrane truth;
  truth.tilt_rad = true_rad, truth.x = s.trolley_m;
  truth.hang(kCable_m);
  double largest = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const plant::PerAxis volts = command_v(0.01 * tick);
    plant::Actuation actuation;
    actuation.drive_v = volts;
    actuation.locks.axis[plant::kHoist] = true;
    integrator.advance(s, actuation, 0.01);
    for (int i = 0; i < 20; ++i) truth.step({volts[0], volts[1]}, 0.0005);
    const auto swing = truth.swing_rad();
    for (const double d : {s.trolley_m - truth.x, s.slew_rad - truth.gamma, s.radial_rad - swing[0],
                           s.tangential_rad - swing[1]})
      largest = std::max(largest, std::abs(d));
  }
  return largest;
}

TEST(TiltedJib, MovesLikeAPointMassOnACableOverGround) {
  EXPECT_LT(largest_difference(kTilt_rad, kTilt_rad), 2e-5);
  EXPECT_LT(largest_difference(-kTilt_rad, -kTilt_rad), 2e-5);
  EXPECT_LT(largest_difference(kTilt_rad, kTilt_rad, Method::fast), 2e-5);
  EXPECT_GT(largest_difference(0, kTilt_rad), 1e-2) << "the motion shows the tilt";
}

TEST(TiltedJib, LeavesTheLoadAtRestInEverySlewAngle) {
  const Model model = tilted(kTilt_rad);
  for (const double slew_rad : {0.0, 1.0, -2.5}) {
    plant::Actuation held;
    held.locks.axis = {true, true, true};
    const plant::Accelerations a =
        model.accelerations({.trolley_m = 0.6, .radial_rad = kTilt_rad, .slew_rad = slew_rad}, held);
    EXPECT_NEAR(a.radial_radps2, 0, 1e-12);
    EXPECT_NEAR(a.tangential_radps2, 0, 1e-12);
  }
}

/// The suspension point of a jib that turns about the vertical moves on a circle of radius x cos a. A swing
/// encoder with an offset does not change this motion.
TEST(TiltedJib, ShortensTheLeverOfTheSlewAxis) {
  plant::Actuation turning;
  turning.locks.axis = {true, true, true};
  turning.locks.acceleration[plant::kSlew] = 0.8;
  const plant::Accelerations a = tilted(kTilt_rad).accelerations(
      {.trolley_m = 0.6, .radial_rad = kTilt_rad, .cable_m = kCable_m}, turning);
  EXPECT_NEAR(a.tangential_radps2, -0.6 * std::cos(kTilt_rad) / kCable_m * 0.8, 1e-12);
}

TEST(TiltedJib, PullsTheTrolleyOfAGantryDownTheRail) {
  constexpr double kMassless_kg = 0;
  plant::Parameters p;
  p.load_mass_kg = kMassless_kg;
  const Model rail{p, {{"jib_tilt", "", {{"angle_rad", kTilt_rad}}}}};
  plant::Actuation free;
  free.locks.axis = {false, true, true};
  EXPECT_NEAR(rail.accelerations({.trolley_m = 1}, free).trolley_mps2,
              -p.gravity_mps2 * std::sin(kTilt_rad) * p.trolley_mass_kg / p.trolley_inertia_kg, 1e-12);
}

TEST(TiltedJib, AddsTheAnglesOfSeveralTerms) {
  const plant::TermSetting half{"jib_tilt", "", {{"angle_rad", 0.5 * kTilt_rad}}};
  const Model twice{{}, {half, half}};
  EXPECT_NEAR(twice.parameters().tilt_sine, std::sin(kTilt_rad), 1e-15);
  EXPECT_EQ(tilted(0).parameters(), plant::Parameters{});
}

}  // namespace
}  // namespace crane::simulator
