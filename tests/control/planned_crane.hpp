#pragma once
/// A crane with friction, encoders and one tick of delay, for tests of whole controllers: nonlinear equations
/// with steps of 0.1 ms, without processes and bus.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "crane/control/friction_compensation.hpp"
#include "crane/control/pendulum_observer.hpp"
#include "crane/plant/equations.hpp"

namespace crane::control {

struct TestCrane {
  plant::Parameters truth;
  std::array<DriveFriction, kAxes> friction;  ///< true friction; factor scales it
  double cable_ratio = 1;                     ///< true / measured cable length
  Design design;                              ///< design of the controllers
};

/// The rig of deploy/rigs/virginia_tech_tower.toml.
inline TestCrane tower_with_friction() {
  TestCrane crane;
  crane.design.friction[kTrolley] = {1.5, 6.0, 0.9, 1.2, 0.9, 1.2, 100, 0.005, 1};
  crane.design.friction[kSlew] = {0.15, 0.05, 0.7, 0.6, 0.7, 0.6, 100, 0.005, 1};
  crane.friction = crane.design.friction;
  return crane;
}

struct TestMove {
  double from_m, to_m, to_rad;
};
inline constexpr TestMove kTestMoves[] = {
    {0.25, 1.0, 0}, {0.9, 0.9, std::numbers::pi / 2}, {0.25, 1.0, std::numbers::pi / 2}};

struct TestResult {
  double settled_s = 0, residual_rad = 0, largest_swing_rad = 0, overshoot = 0;
};

/// Smoothed friction of the true crane, V.
inline double true_friction_v(const DriveFriction& f, double speed) {
  const double side = std::tanh(speed / 0.0005);
  const double coulomb = side > 0 ? f.coulomb_positive_v : f.coulomb_negative_v;
  const double viscous = speed > 0 ? f.viscous_positive_vspm : f.viscous_negative_vspm;
  return f.factor * (coulomb * side + viscous * speed);
}

inline plant::State after_tick(const TestCrane& crane, plant::State s, const Volts& volts) {
  constexpr int kSteps = 100;
  const double h = crane.design.period_s / kSteps;
  const auto rate = [&](const plant::State& at) {
    const plant::Parameters& p = crane.truth;
    const double x_v = volts[kTrolley] - true_friction_v(crane.friction[kTrolley], at.trolley_mps);
    const double g_v = volts[kSlew] - true_friction_v(crane.friction[kSlew], at.slew_radps);
    const auto a = plant::accelerations(p, at,
                                        {.trolley_n = p.trolley_inertia_kg * p.trolley_gain_mps2pv * x_v,
                                         .slew_nm = p.jib_inertia_kgm2 * p.slew_gain_radps2pv * g_v},
                                        0);
    return plant::StateArray{
        at.trolley_mps, at.radial_radps, at.slew_radps, at.tangential_radps, at.cable_mps,
        a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, 0};
  };
  const auto moved = [](const plant::State& at, const plant::StateArray& by, double time_s) {
    auto values = plant::to_array(at);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += time_s * by[i];
    return plant::to_state(values);
  };
  for (int i = 0; i < kSteps; ++i) s = moved(s, rate(moved(s, rate(s), h / 2)), h);
  return s;
}

inline double counted(double value, double counts_per_unit) {
  return std::round(value * counts_per_unit) / counts_per_unit;
}

/// Simulates one move. @param reference_at_s  returns the reference at a time in s after the request
inline TestResult run_move(const TestCrane& crane, const Controller& controller, const TestMove& move,
                           const std::function<Reference(double)>& reference_at_s) {
  const double dt = crane.design.period_s;
  const auto tracking = tracking_law(controller, crane.design),
             anti_swing = anti_swing_law(controller, crane.design);
  plant::State s;
  s.trolley_m = move.from_m;
  s.cable_m = crane.cable_ratio;
  Volts acting{}, command{};
  TestResult result;
  constexpr int kTicks = 1200;
  for (int k = 0; k < kTicks; ++k) {
    Measurement m;
    m.position = {counted(s.trolley_m, 629921.26), counted(s.slew_rad, 57295.78), 1};
    m.speed = {s.trolley_mps, s.slew_radps, 0};
    m.swing_radial_rad = counted(s.radial_rad, 3819.7186), m.swing_radial_radps = s.radial_radps;
    m.swing_tangential_rad = counted(s.tangential_rad, 3819.7186),
    m.swing_tangential_radps = s.tangential_radps;
    acting = command;  // the command of the tick before acts from now on
    m.applied_v = acting;
    const Reference wanted = reference_at_s(k * dt);
    const Volts one = tracking->step(m, wanted).drive_v, other = anti_swing->step(m, wanted).drive_v;
    for (std::size_t i = 0; i < kAxes; ++i) {
      const double control_v = one[i] + other[i];
      command[i] =
          std::clamp(control_v + friction_compensation_v(crane.design.friction[i], control_v, m.speed[i]),
                     -crane.design.volt_limit_v[i], crane.design.volt_limit_v[i]);
    }
    s = after_tick(crane, s, acting);
    const double swing = std::max(std::abs(s.radial_rad), std::abs(s.tangential_rad));
    const bool settled = std::abs(s.trolley_m - move.to_m) < 0.015 &&
                         std::abs(s.slew_rad - move.to_rad) < 0.02 * std::numbers::pi / 2 &&
                         swing < 0.5 * std::numbers::pi / 180;
    if (!settled) result.settled_s = (k + 1) * dt;
    result.largest_swing_rad = std::max(result.largest_swing_rad, swing);
    if (k >= kTicks - 400) result.residual_rad = std::max(result.residual_rad, swing);
    if (move.to_m != move.from_m)
      result.overshoot = std::max(result.overshoot, (s.trolley_m - move.to_m) / (move.to_m - move.from_m));
  }
  return result;
}

}  // namespace crane::control
