#pragma once
/// A laboratory whose amplifier limits its output or the rate of its output. One drive with set-valued
/// Coulomb friction; only recording::Table is shared with the project:
///   x'' = K (w + a sin(2 pi x / l) - (c + mu |w|) sgn(x') - b x')
/// The voltage w follows the command u within |w| <= limit and |w'| <= rate. Impulses of friction in steps of
/// 0.1 ms: the axis sticks exactly.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "crane/recording/csv.hpp"

namespace crane::strange {

struct Amplifier {
  double limit_v = std::numeric_limits<double>::infinity();
  double rate_vps = std::numeric_limits<double>::infinity();
};

struct Axis {
  double gain_mps2pv = 0.83, coulomb_v = 0.34, viscous_vspm = 1.9;
  Amplifier amplifier;
  double disturbance_v = 0;              ///< standard deviation, first order, 0.5 s
  double wave_v = 0, wave_length_m = 1;  ///< a and l
  double gear_share = 0;                 ///< mu
};

inline double wave_of(const Axis& axis, double x) {
  return axis.wave_v * std::sin(2 * std::numbers::pi * x / axis.wave_length_m);
}

/// Motion of the axis under a position controller at 100 Hz. The set point changes every 1.3 s, within 0.3 m
/// of the origin; a critically damped filter at `speed`, rad/s, makes the reference.
inline recording::Table recorded_axis(const Axis& axis, double duration_s, std::uint64_t seed,
                                      double speed = 4) {
  constexpr double kStep_s = 1e-4, kCount_m = 2e-6;
  constexpr int kStepsPerRow = 100;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> gauss;
  recording::Table table;
  table.columns = {{"time_s", {}}, {"trolley_voltage_v", {}}, {"trolley_position_m", {}}};
  double x = 0, v = 0, w = 0, push_v = 0, goal = 0, reference = 0, rate = 0, command_v = 0;
  for (int k = 0; k * kStep_s < duration_s; ++k) {
    if (k % 13000 == 0) goal = 0.3 * uniform(random);
    if (k % kStepsPerRow == 0) {
      const double acceleration = speed * speed * (goal - reference) - 2 * speed * rate;
      rate += 0.01 * acceleration, reference += 0.01 * rate;
      const double measured = kCount_m * std::round(x / kCount_m + 0.5 * gauss(random));
      const double wanted_v = acceleration / axis.gain_mps2pv + 40 * (reference - x) + 9 * (rate - v) +
                              1.9 * rate + 0.3 * std::tanh(rate / 0.01);
      command_v = std::clamp(wanted_v, -10.0, 10.0);
      push_v += -push_v * 0.01 / 0.5 + axis.disturbance_v * std::sqrt(2 * 0.01 / 0.5) * gauss(random);
      table.columns[0].values.push_back(k * kStep_s);
      table.columns[1].values.push_back(command_v);
      table.columns[2].values.push_back(measured);
    }
    const double step_v = axis.amplifier.rate_vps * kStep_s;
    w += std::clamp(std::clamp(command_v, -axis.amplifier.limit_v, axis.amplifier.limit_v) - w, -step_v,
                    step_v);
    v += kStep_s * axis.gain_mps2pv * (w + push_v + wave_of(axis, x) - axis.viscous_vspm * v);
    const double brake = kStep_s * axis.gain_mps2pv * (axis.coulomb_v + axis.gear_share * std::abs(w));
    v -= std::clamp(v, -brake, brake);
    x += kStep_s * v;
  }
  return table;
}

}  // namespace crane::strange
