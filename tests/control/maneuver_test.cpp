/// The dissertation's maneuvers on the full nonlinear equations without friction, ideal sensors, 100 Hz, |V|
/// <= 10: settling times as computed independently of this code (docs/equations.md, table of maneuvers).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "crane/control/law.hpp"
#include "crane/control/trajectory.hpp"
#include "crane/plant/equations.hpp"

namespace crane::control {
namespace {

using std::numbers::pi;

struct Maneuver {
  double from_m, to_m, to_rad;
};
constexpr Maneuver kManeuvers[] = {{0.25, 1.0, 0}, {0.9, 0.9, pi / 2}, {0.25, 1.0, pi / 2}};

plant::StateArray derivative(const plant::Parameters& crane, const plant::StateArray& values,
                             const Volts& v) {
  const plant::State state = plant::to_state(values);
  const plant::Forces forces{.trolley_n = crane.trolley_inertia_kg * crane.trolley_gain_mps2pv * v[kTrolley],
                             .slew_nm = crane.jib_inertia_kgm2 * crane.slew_gain_radps2pv * v[kSlew]};
  const auto a = plant::accelerations(crane, state, forces, 0);
  return {values[5],      values[6],       values[7],     values[8],           values[9],
          a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, 0};
}

/// Integrates one tick with Runge-Kutta steps of 1 ms.
plant::State advanced(const plant::Parameters& crane, const plant::State& state, const Volts& v,
                      double tick_s) {
  auto y = plant::to_array(state);
  const int steps = 10;
  const double h = tick_s / steps;
  const auto moved = [&](const plant::StateArray& k, double by) {
    auto result = y;
    for (std::size_t i = 0; i < y.size(); ++i) result[i] += by * k[i];
    return result;
  };
  for (int n = 0; n < steps; ++n) {
    const auto k1 = derivative(crane, y, v), k2 = derivative(crane, moved(k1, h / 2), v);
    const auto k3 = derivative(crane, moved(k2, h / 2), v), k4 = derivative(crane, moved(k3, h), v);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return plant::to_state(y);
}

Measurement ideal(const plant::State& s) {
  return {{s.trolley_m, s.slew_rad, s.cable_m},
          {s.trolley_mps, s.slew_radps, s.cable_mps},
          s.radial_rad,
          s.radial_radps,
          s.tangential_rad,
          s.tangential_radps};
}

Trajectory trajectory(const Controller& controller, const Maneuver& maneuver, double period_s) {
  const auto axis = [&](double start, double target) {
    if (controller.reference == ReferenceShape::step) return step_profile(start, target);
    return timed_profile(start, target, period_s, period_s / 4);  // (3.54), (3.55)
  };
  return {axis(maneuver.from_m, maneuver.to_m), axis(0, maneuver.to_rad), step_profile(1, 1)};
}

/// True within 2 % of the move (for an unmoved axis 2 % of 0.75 m or 90 degrees) and 0.5 degrees of swing.
bool settled(const plant::State& s, const Maneuver& maneuver) {
  return std::abs(s.trolley_m - maneuver.to_m) < 0.02 * 0.75 &&
         std::abs(s.slew_rad - maneuver.to_rad) < 0.02 * pi / 2 &&
         std::max(std::abs(s.radial_rad), std::abs(s.tangential_rad)) < 0.5 * pi / 180;
}

double settling_time_s(const Controller& controller, const Design& design, const Maneuver& maneuver) {
  const double period_s = 2 * pi * std::sqrt(1 / design.crane.gravity_mps2);
  const auto tracking = controller.make_tracking(design), anti_swing = controller.make_anti_swing(design);
  const Trajectory wanted = trajectory(controller, maneuver, period_s);
  plant::State state;
  state.trolley_m = maneuver.from_m;
  tracking->reset(ideal(state));
  anti_swing->reset(ideal(state));
  double settled_since = 0;
  ReferenceStart start;
  for (int k = 0; k < 2000; ++k) {
    const double t = k * design.period_s;
    Reference reference = reference_at(wanted, t);
    const auto measured = ideal(state);
    start.set_starts(measured, reference);
    const Contribution swing_part = anti_swing->step(measured, reference);
    for (std::size_t i = 0; i < kAxes; ++i) {
      reference[i].position += swing_part.correction[i].position;
      reference[i].speed += swing_part.correction[i].speed;
    }
    Volts v = tracking->step(measured, reference).drive_v;
    for (std::size_t i = 0; i < kAxes; ++i) v[i] = std::clamp(v[i] + swing_part.drive_v[i], -10.0, 10.0);
    state = advanced(design.crane, state, v, design.period_s);
    if (!settled(state, maneuver)) settled_since = t + design.period_s;
  }
  return settled_since;
}

void expect_settling_s(const char* name, double forward_gain, const std::array<double, 3>& expected_s) {
  Design design;
  design.full_state_forward_gain_vpm = forward_gain;
  // A high voltage limit keeps K at 8, which would saturate the slew drive in maneuvers 2 and 3.
  design.volt_limit_v.fill(1000);
  for (std::size_t i = 0; i < 3; ++i)
    // Tolerance of two ticks: sampling of the settling time, and rounding of the printed value.
    EXPECT_NEAR(settling_time_s(*find_controller(name), design, kManeuvers[i]), expected_s[i], 0.02)
        << name << " maneuver " << i + 1;
}

TEST(Maneuvers, SettleWithGainSchedulingAsComputedIndependently) {
  expect_settling_s("gain_scheduling_partial", 4, {3.38, 4.61, 4.82});
  expect_settling_s("gain_scheduling_full", 2, {3.44, 5.07, 5.50});
  expect_settling_s("gain_scheduling_full", 4, {3.38, 4.76, 5.04});
  expect_settling_s("gain_scheduling_full", 8, {3.30, 4.50, 4.64});
}

TEST(Maneuvers, SettleWithTheForwardGainThatTheVoltsAllow) {
  // K = 8 demands 12.6 V of the slew drive at the start; 10 V permit K = 6.37 for 90 degrees.
  Design design;
  design.full_state_forward_gain_vpm = 8;
  const auto& full = *find_controller("gain_scheduling_full");
  for (std::size_t i = 0; i < 3; ++i) {
    const double settled_s = settling_time_s(full, design, kManeuvers[i]);
    const std::array with_4{3.38, 4.76, 5.04}, with_8{3.30, 4.50, 4.64};
    EXPECT_GT(settled_s, with_8[i] - 0.02) << "maneuver " << i + 1;
    EXPECT_LT(settled_s, with_4[i]) << "maneuver " << i + 1;
  }
}

TEST(Maneuvers, SettleWithAntiSwingTrackingAsComputedIndependently) {
  expect_settling_s("anti_swing_pd", 4, {4.30, 5.09, 5.16});
  expect_settling_s("delayed_1", 4, {5.13, 5.43, 5.56});
  expect_settling_s("fuzzy_printed", 4, {5.22, 6.24, 5.55});
}

TEST(Maneuvers, DoNotSettleWithTrackingOnly) {
  for (const auto& maneuver : kManeuvers)
    EXPECT_GT(settling_time_s(*find_controller("none"), Design{}, maneuver), 19.0);
}

TEST(Maneuvers, SettleWithGeneratedRulesNearlyAsWithDelayed1) {
  for (const auto& maneuver : kManeuvers)
    EXPECT_NEAR(settling_time_s(*find_controller("fuzzy_generated"), Design{}, maneuver),
                settling_time_s(*find_controller("delayed_1"), Design{}, maneuver), 0.5);
}

TEST(Maneuvers, SettleWithBothDelayedCorrectionsAndSoonerWithTheOptimisedGains) {
  for (const auto& maneuver : kManeuvers) {
    const double printed_s = settling_time_s(*find_controller("delayed_2"), Design{}, maneuver);
    EXPECT_LT(printed_s, 19);
    EXPECT_LT(settling_time_s(*find_controller("delayed_2_optimised"), Design{}, maneuver), printed_s);
  }
}

TEST(Maneuvers, SettleNoSoonerWithTheHigherLeastDampingOfDelayed1) {
  EXPECT_NEAR(settling_time_s(*find_controller("delayed_1_optimised"), Design{}, kManeuvers[0]), 5.36, 0.02);
}

}  // namespace
}  // namespace crane::control
