#include "force/position_spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "score/sealed_case.hpp"

namespace crane::diagnosis {
namespace {

/// x'' = K (V + a sin(2 pi x / w + psi)), or K (V + (a sin(2 pi x / w + psi) - c) sgn x') for a friction with
/// a constant part c, in small steps.
PositionWave strongest_of(WaveOf of, double command_v, double amplitude_v, double period_m,
                          double phase_rad) {
  configuration::Rig rig = score::rig_file_of("drive_axis");
  rig.terms.clear();
  const double constant_v = of == WaveOf::friction ? 2 * amplitude_v : 0;
  const double gain = rig.plant.trolley_gain_mps2pv;
  diagnosis::Run run;
  run.name = "ripple";
  run.period_s = 0.01;
  double x = 0, v = 0;
  for (int k = 0; k < 3000; ++k) {
    const double u = command_v * std::cos(2 * std::numbers::pi * 0.2 * 0.01 * k);
    run.measured[kTrolleyPosition].push_back(x);
    run.command_v.push_back({u, 0, 0});
    run.cable_m.push_back(1);
    for (int step = 0; step < 100; ++step) {
      const double wave_v = amplitude_v * std::sin(2 * std::numbers::pi * x / period_m + phase_rad);
      v += 1e-4 * gain *
           (u + (of == WaveOf::friction ? std::copysign(1.0, v) * (wave_v - constant_v) : wave_v));
      x += 1e-4 * v;
    }
  }
  std::vector<PreparedRun> runs;
  runs.push_back(prepare(std::move(run), rig));
  const auto waves =
      strongest_waves(pieces_of(runs, replays_of(runs, {rig.plant, rig.terms}), kTrolleyPosition), 3, of);
  if (waves.empty()) throw std::runtime_error("no wave found");
  return {waves[0].period, waves[0].amplitude / gain, waves[0].phase_rad};
}

void expect_found(WaveOf of, double command_v, double amplitude_v, double period_m) {
  constexpr double kPhase = 1.1;
  const auto found = strongest_of(of, command_v, amplitude_v, period_m, kPhase);
  EXPECT_NEAR(found.period, period_m, 0.02 * period_m);
  EXPECT_NEAR(found.amplitude, amplitude_v, 0.4 * amplitude_v);
  EXPECT_NEAR(std::remainder(found.phase_rad - kPhase, 2 * std::numbers::pi), 0, 0.6);
}

TEST(PositionSpectrum, FindsPeriodAmplitudeAndPhaseOfARipple) {
  expect_found(WaveOf::force, 0.15, 0.2, 0.04);
}

TEST(PositionSpectrum, FindsPeriodAmplitudeAndPhaseOfAFriction) {
  expect_found(WaveOf::friction, 1, 0.1, 0.2);
}

}  // namespace
}  // namespace crane::diagnosis
