#pragma once
/// The maneuvers of the dissertation in closed loop with the full model, sampled, without board and delay.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "crane/plant/model.hpp"
#include "crane/plant/state.hpp"

namespace crane::test {

inline constexpr double kTick_s = 0.01;

struct Maneuver {
  double start_trolley_m = 0.25, target_trolley_m = 1;
  double target_slew_rad = 0;
};
inline constexpr Maneuver kManeuver1{0.25, 1, 0};
inline constexpr Maneuver kManeuver2{0.9, 0.9, std::numbers::pi / 2};
inline constexpr Maneuver kManeuver3{0.25, 1, std::numbers::pi / 2};

struct AxisGains {
  double k, speed, swing;
};

/// Partial gain scheduling, closed form (K_phi' = 0) for a load ratio m_t and a drive gain K_m. The root r of
/// (4/pi) r^2 - sqrt(2) (1 - 4/pi^2) r - 4/pi = 0 makes the four poles (s+a)^2 (s^2 + sqrt(2) w s + w^2),
/// a = (2/pi) w_0, w = r w_0.
inline AxisGains partial_gains(double gravity, double cable_m, double ratio, double drive_gain) {
  constexpr double kRatio = 1.383413;
  const double w0 = std::sqrt(gravity / cable_m), w = kRatio * w0, a = 2 / std::numbers::pi * w0;
  const double k = a * a * w * w / (w0 * w0) / drive_gain;
  const double swing =
      (a * a + 2 * std::sqrt(2.0) * a * w + w * w - w0 * w0 * (1 + ratio)) / (k * drive_gain) - 1;
  return {k, 2 / a + std::sqrt(2.0) / w, cable_m * swing};
}

/// V_x = K(x_r - x - K_x' x' - K_phi phi), V_gamma = K(gamma_r - gamma - K_gamma' gamma' + K_theta theta),
/// |V| <= 10.
inline plant::PerAxis partial_gain_scheduling(const plant::Parameters& p, const plant::State& s,
                                              const Maneuver& m) {
  const double x = std::max(s.trolley_m, 0.1), inertia = 1 + p.trolley_to_jib_ratio() * x * x;
  const AxisGains t =
      partial_gains(p.gravity_mps2, s.cable_m, p.load_to_trolley_ratio(), p.trolley_gain_mps2pv);
  const AxisGains r = partial_gains(p.gravity_mps2, s.cable_m, p.load_to_jib_ratio() * x * x / inertia,
                                    p.slew_gain_radps2pv / inertia);
  const double trolley_v =
      t.k * (m.target_trolley_m - s.trolley_m - t.speed * s.trolley_mps - t.swing * s.radial_rad);
  const double slew_v =
      r.k * (m.target_slew_rad - s.slew_rad - r.speed * s.slew_radps + r.swing / x * s.tangential_rad);
  return {std::clamp(trolley_v, -10.0, 10.0), std::clamp(slew_v, -10.0, 10.0), 0};
}

/// Position within 2 % of the move (for an unmoved axis 2 % of 0.75 m or 90 degrees), swings below 0.5
/// degrees.
inline bool settled(const plant::State& s, const Maneuver& m) {
  constexpr double kSwing_rad = 0.5 * std::numbers::pi / 180;
  return std::abs(s.trolley_m - m.target_trolley_m) <= 0.02 * 0.75 &&
         std::abs(s.slew_rad - m.target_slew_rad) <= 0.02 * std::numbers::pi / 2 &&
         std::abs(s.radial_rad) < kSwing_rad && std::abs(s.tangential_rad) < kSwing_rad;
}

/// Drive friction of the dissertation's rig in volts, with 0.15 for the misprint in (4.16).
inline std::vector<plant::TermSetting> rig_friction(double smoothing_speed = 0.0005) {
  return {{"drive_friction",
           "trolley",
           {{"viscous_positive_vspm", 1.5},
            {"viscous_negative_vspm", 6},
            {"coulomb_positive_v", 0.9},
            {"coulomb_negative_v", 1.2},
            {"smoothing_speed", smoothing_speed}}},
          {"drive_friction",
           "slew",
           {{"viscous_positive_vspm", 0.15},
            {"viscous_negative_vspm", 0.05},
            {"coulomb_positive_v", 0.7},
            {"coulomb_negative_v", 0.6},
            {"smoothing_speed", smoothing_speed}}}};
}

/// Friction compensation of the rig's friction, (3.1)-(3.5) with A = 100 and d_s = 5 mm/s.
inline double compensation_v(double speed, double demand_v, std::array<double, 4> b_b_c_c) {
  constexpr double kZeroBand = 0.005, kSlope_pv = 100;
  const auto [b_positive, b_negative, c_positive, c_negative] = b_b_c_c;
  if (speed > kZeroBand) return c_positive + b_positive * speed;
  if (speed < -kZeroBand) return -c_negative + b_negative * speed;
  return 0.5 * (c_positive - c_negative) + 0.5 * (c_positive + c_negative) * std::tanh(kSlope_pv * demand_v);
}

/// The law plus exact compensation of rig_friction().
inline plant::PerAxis compensated(const plant::Parameters& p, const plant::State& s, const Maneuver& m) {
  plant::PerAxis v = partial_gain_scheduling(p, s, m);
  v[0] = std::clamp(v[0] + compensation_v(s.trolley_mps, v[0], {1.5, 6, 0.9, 1.2}), -10.0, 10.0);
  v[1] = std::clamp(v[1] + compensation_v(s.slew_radps, v[1], {0.15, 0.05, 0.7, 0.6}), -10.0, 10.0);
  return v;
}

inline plant::Actuation driven(const plant::PerAxis& volts) {
  plant::Actuation actuation;
  actuation.drive_v = volts;
  return actuation;
}

/// One classical Runge-Kutta step of the model.
inline plant::State runge_kutta_step(const plant::Model& model, const plant::State& state,
                                     const plant::Actuation& actuation, double h_s) {
  using plant::StateArray;
  const auto rates = [&](const StateArray& values) {
    const plant::State s = plant::to_state(values);
    const plant::Accelerations a = model.accelerations(s, actuation);
    return StateArray{s.trolley_mps,  s.radial_radps,  s.slew_radps,  s.tangential_radps,  s.cable_mps,
                      a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, a.cable_mps2};
  };
  const auto along = [](StateArray y, const StateArray& k, double h) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += h * k[i];
    return y;
  };
  StateArray y = plant::to_array(state);
  const StateArray k1 = rates(y), k2 = rates(along(y, k1, h_s / 2)), k3 = rates(along(y, k2, h_s / 2)),
                   k4 = rates(along(y, k3, h_s));
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += h_s / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  return plant::to_state(y);
}

}  // namespace crane::test
