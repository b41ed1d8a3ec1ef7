#pragma once
/// A laboratory with unusual recordings. The gantry of deploy/rigs/gantry.toml, computed from Lagrange's
/// equations with a Runge-Kutta method, without code of the diagnosis:
///   x'' (M + m sin^2 r) = F + P sin^2 r - m sin r (g cos r + l r'^2)
///   l r'' = x'' cos r - g sin r - P / m cos r,   F = M k u - c x'
/// P is a horizontal force on the load, which hangs at x - l sin r.
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "crane/recording/csv.hpp"

namespace crane::strange {

struct Load {
  double time_s = 0, position_m = 0, swing_rad = 0;
};

struct Gantry {
  double inertia_kg = 12, load_kg = 3, gain_mps2pv = 1.2, gravity_mps2 = 9.81, cable_m = 1.5;
  double drag_nspm = 0;  ///< viscous, of the trolley; not in the rig file
  double rub_n = 0;  ///< dry friction of the trolley in the first third of every kRub_s; not in the rig file
  std::function<double(const Load&)> push_n{};  ///< horizontal, on the load; empty: none
};

struct Instant {
  double time_s = 0, volts = 0, trolley_m = 0, swing_rad = 0;
};

inline constexpr double kTick_s = 0.0005, kRub_s = 3.7;

/// The crane every 0.5 ms under a command.
inline std::vector<Instant> moved(const Gantry& crane, double duration_s,
                                  const std::function<double(double)>& command_v, double swing_rad = 0) {
  using State = std::array<double, 4>;  // x, x', r, r'
  double time_s = 0;
  const auto slope = [&](const State& s, double volts) {
    const double sine = std::sin(s[2]), cosine = std::cos(s[2]);
    const double rub_n = std::fmod(time_s, kRub_s) < kRub_s / 3 ? crane.rub_n * std::tanh(s[1] / 0.002) : 0;
    const double force = crane.inertia_kg * crane.gain_mps2pv * volts - crane.drag_nspm * s[1] - rub_n;
    const double push = crane.push_n ? crane.push_n({time_s, s[0] - crane.cable_m * sine, s[2]}) : 0;
    const double a = (force + push * sine * sine -
                      crane.load_kg * sine * (crane.gravity_mps2 * cosine + crane.cable_m * s[3] * s[3])) /
                     (crane.inertia_kg + crane.load_kg * sine * sine);
    return State{s[1], a, s[3],
                 (a * cosine - crane.gravity_mps2 * sine - push / crane.load_kg * cosine) / crane.cable_m};
  };
  const auto along = [](const State& s, const State& d, double h) {
    State moved_state = s;
    for (std::size_t i = 0; i < s.size(); ++i) moved_state[i] += h * d[i];
    return moved_state;
  };
  State s{1, 0, swing_rad, 0};
  std::vector<Instant> all;
  for (int k = 0; k * kTick_s < duration_s; ++k) {
    time_s = k * kTick_s;
    const double volts = command_v(time_s);
    all.push_back({time_s, volts, s[0], s[2]});
    const State a = slope(s, volts), b = slope(along(s, a, kTick_s / 2), volts),
                c = slope(along(s, b, kTick_s / 2), volts), d = slope(along(s, c, kTick_s), volts);
    for (std::size_t i = 0; i < s.size(); ++i) s[i] += kTick_s / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return all;
}

/// Three incommensurate tones and steps.
inline double rich_command(double t) {
  return 0.9 * std::cos(1.1 * t) + 0.7 * std::cos(2.9 * t + 1) + 0.3 * std::cos(6.3 * t + 2) +
         (std::fmod(t, 3.7) < 0.6 ? 0.5 : -0.1);
}

struct Recording {
  double row_s = 0.01;       ///< of the file
  double jitter = 0;         ///< of a row's time, uniform, as a share of row_s
  double dropped = 0;        ///< share of rows
  double swing_every_s = 0;  ///< interval of the swing's values; 0: every row
  double swing_mean_s = 0;   ///< moving average of the swing's sensor
  double position_step_m = 2.5e-5, swing_step_rad = 3.8e-4;
  double position_noise_m = 0, swing_noise_rad = 0;
  std::uint64_t seed = 1;
};

/// Table of the laboratory's file.
inline recording::Table recorded(const std::vector<Instant>& truth, const Recording& r) {
  recording::Table table;
  table.columns = {
      {"time_s", {}}, {"trolley_voltage_v", {}}, {"trolley_position_m", {}}, {"swing_radial_rad", {}}};
  std::mt19937_64 random(r.seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> gauss;
  const auto mean = static_cast<std::size_t>(r.swing_mean_s / kTick_s);
  double next_swing_s = 0;
  for (int row = 0;; ++row) {
    const double at_s = row * r.row_s + (row == 0 ? 0 : 0.5 * r.jitter * r.row_s * uniform(random));
    const auto k = static_cast<std::size_t>(std::lround(at_s / kTick_s));
    if (k >= truth.size()) break;
    const double drawn = 0.5 * (1 + uniform(random));
    const double error_m = r.position_noise_m * gauss(random), error_rad = r.swing_noise_rad * gauss(random);
    if (row > 0 && drawn < r.dropped) continue;
    double swing = 0;
    const std::size_t first = k - std::min(k, mean);
    for (std::size_t i = first; i <= k; ++i) swing += truth[i].swing_rad / static_cast<double>(k - first + 1);
    const auto counted = [](double value, double step) {
      return step > 0 ? std::round(value / step) * step : value;
    };
    const bool frame = truth[k].time_s + 1e-9 >= next_swing_s;
    if (frame) next_swing_s += r.swing_every_s;
    table.columns[0].values.push_back(truth[k].time_s);
    table.columns[1].values.push_back(truth[k].volts);
    table.columns[2].values.push_back(counted(truth[k].trolley_m + error_m, r.position_step_m));
    table.columns[3].values.push_back(frame ? counted(swing + error_rad, r.swing_step_rad)
                                            : std::numeric_limits<double>::quiet_NaN());
  }
  return table;
}

}  // namespace crane::strange
