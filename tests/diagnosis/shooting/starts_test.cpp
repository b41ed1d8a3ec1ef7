/// Starts of windows for a swing outside the model.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kRow_s = 0.01;

configuration::Rig pendulum() { return configuration::load_rig(CRANE_RIGS "/pendulum.toml"); }

/// Free pendulum of the rig, integrated with the midpoint rule; a sine is added to the measured angle.
Run swing(const configuration::Rig& rig, const std::string& name, double start_rad, double line_rad,
          double line_hz, double phase_rad) {
  const double cable_m = rig.start.position[plant::kHoist];
  const double w2 = rig.plant.gravity_mps2 / cable_m;
  Run run;
  run.name = name;
  run.period_s = kRow_s;
  double angle = start_rad, rate = 0;
  for (int k = 0; k < 1200; ++k) {
    const double line = line_rad * std::sin(2 * M_PI * line_hz * k * kRow_s + phase_rad);
    run.measured[kRadialSwing].push_back(angle + line);
    run.command_v.emplace_back();
    run.cable_m.push_back(cable_m);
    constexpr int kSteps = 20;
    constexpr double h = kRow_s / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double middle = angle + 0.5 * h * rate, middle_rate = rate - 0.5 * h * w2 * std::sin(angle);
      rate -= h * w2 * std::sin(middle);
      angle += h * middle_rate;
    }
  }
  return run;
}

class Starts : public testing::TestWithParam<unsigned> {};

TEST_P(Starts, LeaveNoWindowWithALargerErrorThanALoadAtRest) {
  const auto rig = pendulum();
  std::mt19937 random{GetParam()};
  std::uniform_real_distribution<double> amplitude{0.1, 0.3}, frequency{1.5, 4}, phase{0, 6.28};
  const double line_rad = amplitude(random), line_hz = frequency(random);
  const auto run = [&](const char* name, double start_rad) {
    return swing(rig, name, start_rad, line_rad, line_hz, phase(random));
  };
  const auto found = diagnose(rig, {run("a", 0.2), run("b", 0.15)}, {run("c", 0.18)});
  const auto& held_out = found.held_out;
  const double line_rms = line_rad / std::sqrt(2);
  SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", line of " + std::to_string(line_rad) + " rad at " +
               std::to_string(line_hz) + " Hz");
  EXPECT_EQ(found.verdict, Verdict::unknown) << found.sentence;
  EXPECT_LE(held_out.baseline_rms.at("swing_radial_rad"), 1.1 * line_rms);
  EXPECT_LE(held_out.whole_baseline_rms.at("swing_radial_rad"), 1.1 * line_rms);
  EXPECT_LE(held_out.baseline_rms.at("swing_radial_rad"), held_out.held_value_rms.at("swing_radial_rad"));
  EXPECT_TRUE(found.causes.empty()) << found.causes[0].name;
}

INSTANTIATE_TEST_SUITE_P(Lines, Starts, testing::Range(20261U, 20267U));

}  // namespace
}  // namespace crane::diagnosis
