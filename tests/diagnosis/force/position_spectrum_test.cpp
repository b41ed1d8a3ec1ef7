#include "force/position_spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "score/sealed_case.hpp"

namespace crane::diagnosis {
namespace {

/// x'' = K (V + a sin(2 pi x / w + psi)) in small steps.
TEST(PositionSpectrum, FindsPeriodAmplitudeAndPhaseOfARipple) {
  configuration::Rig rig = score::rig_file_of("drive_axis");
  rig.terms.clear();
  constexpr double kAmplitude_v = 0.2, kPeriod_m = 0.04, kPhase = 1.1;
  const double gain = rig.plant.trolley_gain_mps2pv;
  diagnosis::Run run;
  run.name = "ripple";
  run.period_s = 0.01;
  double x = 0, v = 0;
  for (int k = 0; k < 3000; ++k) {
    const double u = 0.15 * std::cos(2 * std::numbers::pi * 0.2 * 0.01 * k);
    run.measured[kTrolleyPosition].push_back(x);
    run.command_v.push_back({u, 0, 0});
    run.cable_m.push_back(1);
    for (int step = 0; step < 100; ++step) {
      v += 1e-4 * gain * (u + kAmplitude_v * std::sin(2 * std::numbers::pi * x / kPeriod_m + kPhase));
      x += 1e-4 * v;
    }
  }
  std::vector<PreparedRun> runs;
  runs.push_back(prepare(std::move(run), rig));
  const auto waves =
      strongest_waves(pieces_of(runs, replays_of(runs, {rig.plant, rig.terms}), kTrolleyPosition), 3);
  ASSERT_FALSE(waves.empty());
  EXPECT_NEAR(waves[0].period, kPeriod_m, 0.02 * kPeriod_m);
  EXPECT_NEAR(waves[0].amplitude, gain * kAmplitude_v, 0.4 * gain * kAmplitude_v);
  EXPECT_NEAR(std::remainder(waves[0].phase_rad - kPhase, 2 * std::numbers::pi), 0, 0.6);
}

}  // namespace
}  // namespace crane::diagnosis
