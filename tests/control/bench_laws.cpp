#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "crane/control/adaptation.hpp"
#include "crane/control/friction_compensation.hpp"
#include "crane/control/law.hpp"
#include "crane/control/shaper.hpp"
#include "crane/control/stick.hpp"
#include "crane/control/trajectory.hpp"
#include "crane/control/zero_phase.hpp"
#include "stick_history.hpp"

namespace crane::control {
namespace {

void step_law(benchmark::State& state, std::unique_ptr<Law> (*make)(const Design&)) {
  const auto law = make(Design{});
  Measurement measured;
  measured.position = {0.7, 0.3, 1.2};
  law->reset(measured);
  Reference reference;
  for (auto _ : state) {
    measured.swing_radial_rad = measured.swing_tangential_rad = 0.1 - measured.swing_radial_rad;
    benchmark::DoNotOptimize(law->step(measured, reference));
  }
}

void friction(benchmark::State& state) {
  DriveFriction parameters;
  parameters.stiction_positive_v = parameters.stiction_negative_v = parameters.factor = 1;
  double control_v = 0.001;
  for (auto _ : state)
    benchmark::DoNotOptimize(friction_compensation_v(parameters, control_v = -control_v, 0));
}

/// A trolley that moves back and forth: every tick evaluates the force balance, every sixth tick updates the
/// filter.
void adaptation(benchmark::State& state) {
  Design design;
  design.friction.fill({1.5, 6.0, 0.9, 1.2, 0.9, 1.2, 100, 0.005, 1});
  design.adaptation.enabled = true;
  Adaptation law{design};
  AdaptationInput input;
  input.consecutive = true;
  input.measured.position = {0.7, 0.3, 1.2};
  double time_s = 0;
  for (auto _ : state) {
    time_s += design.period_s;
    input.measured.position[kTrolley] = 0.7 + 0.3 * std::sin(time_s);
    input.measured.position[kSlew] = 0.5 * std::sin(time_s);
    input.measured.swing_radial_rad = input.measured.swing_tangential_rad = 0.05 * std::sin(3 * time_s);
    law.step(input);
    benchmark::DoNotOptimize(law.friction());
  }
}

void reference(benchmark::State& state) {
  const auto profile = limited_profile(0, 1, {0.5, 1, 10});
  const Shaper shaper(Shaping::ei, 2);
  double time_s = 0;
  for (auto _ : state) {
    time_s = time_s > 5 ? 0 : time_s + 0.01;
    benchmark::DoNotOptimize(shaper.at(profile, time_s));
  }
}

/// Three axes whose stick reverses about four times a second, with the longest shaper.
void stick(benchmark::State& state) {
  const StickLimits limits = test::tower_stick(Shaping::zvd);
  StickMemory memory;
  Reference start;
  start[kTrolley].position = start[kHoist].position = 1;
  begin(limits, start, memory);
  test::RandomStick hand{1, {true, true, true}, 0.5};
  for (auto _ : state)
    benchmark::DoNotOptimize(step(limits, test::speeds(limits, hand.next(limits.period_s)), memory));
}

void zero_phase_of_a_minute(benchmark::State& state) {
  std::vector<double> samples(6000);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = static_cast<double>(k % 100);
  for (auto _ : state) benchmark::DoNotOptimize(zero_phase_butterworth(samples, 0.05));
}

const bool kRegistered = [] {
  for (const auto& controller : controllers()) {
    const std::string name(controller.name);
    benchmark::RegisterBenchmark((name + "/tracking").c_str(), step_law, controller.make_tracking);
    benchmark::RegisterBenchmark((name + "/anti_swing").c_str(), step_law, controller.make_anti_swing);
  }
  benchmark::RegisterBenchmark("s_curve_shaped_ei", reference);
  benchmark::RegisterBenchmark("stick_zvd", stick);
  benchmark::RegisterBenchmark("zero_phase_6000_samples", zero_phase_of_a_minute);
  benchmark::RegisterBenchmark("friction_compensation", friction);
  benchmark::RegisterBenchmark("adaptation", adaptation);
  return true;
}();

}  // namespace
}  // namespace crane::control
