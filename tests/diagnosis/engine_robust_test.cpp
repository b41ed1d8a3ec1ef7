/// Cauchy loss, motion profile, spectrum over position.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "force/position_spectrum.hpp"
#include "noise/motion_profile.hpp"
#include "robust.hpp"
#include "sealed_case.hpp"

namespace crane::diagnosis {
namespace {

TEST(Loss, IsQuadraticForNoiseAndLogarithmicForSlips) {
  EXPECT_NEAR(loss_of(0.3), 0.09, 0.001);
  EXPECT_LT(loss_of(100), 10 * 10);
  for (const double e : {-4.0, -0.5, 0.2, 3.0, 30.0})
    EXPECT_NEAR(weight_of(e) * e, (loss_of(e + 1e-5) - loss_of(e - 1e-5)) / 4e-5, 1e-6) << e;
}

/// 1 s at 0.1 m/s, 1 s of rest, 1 s back.
TEST(MotionProfile, HasThePhasesOfTheMotion) {
  PreparedRun run;
  std::vector<double>& position = run.on_grid[kTrolleyPosition];
  double x = 0;
  for (int k = 0; k < 300; ++k) position.push_back(x += k < 100 ? 1e-3 : k < 200 ? 0 : -1e-3);
  run.run.period_s = 0.01;
  run.run.measured[kTrolleyPosition] = position;
  const MotionProfile profile = motion_profile_of(run, kTrolleyPosition, 20, 260);
  EXPECT_EQ(profile[30].phase, MotionPhase::moving);
  EXPECT_LT(profile[30].slowness, 1e-9);
  EXPECT_EQ(profile[130].phase, MotionPhase::standing);
  EXPECT_EQ(profile[130].slowness, 1);
  EXPECT_NE(profile[82].phase, MotionPhase::standing) << "it moved a few rows before";
  EXPECT_EQ(profile[230].phase, MotionPhase::moving);
}

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
