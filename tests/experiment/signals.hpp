#pragma once
/// Runs with known figures of merit.
#include <cmath>
#include <vector>

#include "crane/experiment/metrics.hpp"

namespace crane::experiment {

inline constexpr double kPeriod_s = 0.01;

/// `at(t)` sampled at 0, 0.01, ..., `end_s`.
template <class Signal>
std::vector<Sample> sampled(double end_s, Signal at) {
  std::vector<Sample> run;
  for (std::uint64_t tick = 0; static_cast<double>(tick) * kPeriod_s <= end_s + 1e-9; ++tick) {
    const double time_s = static_cast<double>(tick) * kPeriod_s;
    Sample sample = at(time_s);
    sample.time_s = time_s;
    sample.tick = tick;
    run.push_back(sample);
  }
  return run;
}

/// Second-order step response from 0 to 1 with damping z and frequency w.
inline double step_response(double t, double z, double w) {
  const double wd = w * std::sqrt(1 - z * z);
  return t <= 0 ? 0 : 1 - std::exp(-z * w * t) * (std::cos(wd * t) + z * w / wd * std::sin(wd * t));
}

/// Trolley from 0.25 to 1.0 m at `start_s`.
inline Maneuver trolley_move(double start_s = 0) { return {start_s, start_s, {0.25, 0, 1}, {1.0, 0, 1}}; }

}  // namespace crane::experiment
