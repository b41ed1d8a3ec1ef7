#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "crane/diagnosis/replay.hpp"
#include "crane/simulator/integrator.hpp"
#include "crane/stepper/friction_step.hpp"
#include "shooting/problem.hpp"

namespace crane::diagnosis {
namespace {

using stepper::friction_step, stepper::FrictionStep, stepper::implicit_speed;

using plant::State;

configuration::Rig tower_with(const std::vector<plant::TermSetting>& terms) {
  configuration::Rig rig = configuration::load_rig(std::string{CRANE_RIGS} + "/virginia_tech_tower.toml");
  rig.terms.insert(rig.terms.end(), terms.begin(), terms.end());
  return rig;
}

/// The rig under a rich command, by CVODE: exact positions at every tick.
Run integrated(const configuration::Rig& rig, double seconds, double liveliness = 1) {
  plant::Model model(rig.plant, rig.terms, rig.period_s);
  simulator::Integrator integrator(model);
  Run run;
  run.name = "CVODE";
  run.period_s = rig.period_s;
  State state{.trolley_m = 0.7, .radial_rad = 0.05, .tangential_rad = -0.03};
  plant::InnerState inner{};
  const auto rows = static_cast<std::size_t>(seconds / rig.period_s);
  for (std::size_t k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) * rig.period_s;
    run.measured[kTrolleyPosition].push_back(state.trolley_m);
    run.measured[kSlewAngle].push_back(state.slew_rad);
    run.measured[kRadialSwing].push_back(state.radial_rad);
    run.measured[kTangentialSwing].push_back(state.tangential_rad);
    run.cable_m.push_back(state.cable_m);
    run.command_v.push_back({liveliness * (2.5 * std::sin(3 * t) + std::sin(7.7 * t)),
                             liveliness * (1.5 * std::cos(2 * t) + 0.8 * std::sin(5 * t)), 0});
    plant::Actuation actuation;
    actuation.drive_v = model.drive_voltage(run.command_v.back());
    actuation.locks.axis[plant::kHoist] = true;
    (void)integrator.advance(state, inner, actuation, rig.period_s);
  }
  return run;
}

/// Calls visit(replayed less measured) for every row of windows of 2 s from the measured start.
template <class Visit>
void visit_errors(const Run& run, const configuration::Rig& rig, Part part, Visit&& visit) {
  const PreparedRun prepared = prepare(run, rig);
  const Replay replay(prepared, {rig.plant, rig.terms});
  const auto outputs = simulated_outputs(prepared, part);
  const std::size_t rows = 200;
  for (std::size_t first = 5; first + rows < run.rows(); first += rows) {
    std::vector<double> out(rows * outputs.size());
    auto start = replay.measured_start(part, first);
    // More accurate than the measured rate, because this test checks the equations.
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const auto& y = run.measured[outputs[i]];
      start[2 * i] = y[first];
      start[2 * i + 1] =
          (8 * (y[first + 1] - y[first - 1]) - (y[first + 2] - y[first - 2])) / (12 * run.period_s);
    }
    replay.run(part, first, rows, start, out);
    for (std::size_t i = 0; i < outputs.size(); ++i)
      for (std::size_t k = 0; k < rows; ++k) visit(out[i * rows + k] - run.measured[outputs[i]][first + k]);
  }
}

double worst(const Run& run, const configuration::Rig& rig, Part part) {
  double most = 0;
  visit_errors(run, rig, part, [&](double error) { most = std::max(most, std::abs(error)); });
  return most;
}

double rms(const Run& run, const configuration::Rig& rig, Part part) {
  double squares = 0, count = 0;
  visit_errors(run, rig, part, [&](double error) { squares += error * error, ++count; });
  return std::sqrt(squares / count);
}

TEST(FixedStepReplay, AgreesWithCvodeWithoutFriction) {
  configuration::Rig rig = tower_with({});
  rig.terms.clear();
  // small amplitude, because without friction the crane would leave its track
  const auto run = integrated(rig, 8, 0.15);
  EXPECT_LT(worst(run, rig, Part::drive),
            1.5e-4);                             // error of a difference quotient, integrated twice over 2 s
  EXPECT_LT(worst(run, rig, Part::load), 7e-5);  // a quarter of a count
  EXPECT_LT(worst(run, rig, Part::whole), 1.5e-4);
}

TEST(FixedStepReplay, AgreesWithCvodeThroughReversalsWithStiffFriction) {
  const configuration::Rig rig = tower_with({});
  const auto run = integrated(rig, 8);
  EXPECT_LT(worst(run, rig, Part::drive), 5e-4);
  EXPECT_LT(worst(run, rig, Part::load), 7e-5);
}

TEST(FixedStepReplay, OfTheLoadDependsOnADragOfTheLoad) {
  const configuration::Rig plain = tower_with({});
  const configuration::Rig dragged = tower_with({{"load_linear_drag", "", {{"coefficient_nspm", 0.5}}}});
  const auto run = integrated(dragged, 8);
  EXPECT_LT(worst(run, dragged, Part::load), 7e-5);
  EXPECT_GT(worst(run, plain, Part::load), 5e-3);
}

/// The position behind a gap is not measured, and the times of impacts are chaotic: without the correction by
/// the motor's speed, the true gap would not fit better than no gap.
TEST(FixedStepReplay, OfTheLoadFitsBestWithTheTrueGapOfTheDrive) {
  constexpr double kGap_rad = 0.01, kClearly = 0.4;
  const auto with_gap = [](double gap_rad, double guide) {
    return tower_with(
        {{"backlash", "slew", {{"gap", gap_rad}, {"guide_deceleration", guide}, {"driven_share", 0.65}}}});
  };
  std::map<double, double> rms_of_gap;  // rms of the residual by gap, summed over the guides
  for (const double guide : {0.1, 0.15, 0.2}) {
    const auto run = integrated(with_gap(kGap_rad, guide), 30, 0.5);
    for (const double gap_rad : {kGap_rad, 0.0, 0.5 * kGap_rad, 2 * kGap_rad})
      rms_of_gap[gap_rad] += rms(run, with_gap(gap_rad, guide), Part::load);
  }
  for (const auto& [gap_rad, sum] : rms_of_gap)
    if (gap_rad != kGap_rad) {
      EXPECT_LT(rms_of_gap[kGap_rad], kClearly * sum) << gap_rad;
    }
}

/// A command that changes at every row, delayed by 3.5 rows, on an axis without friction.
TEST(FixedStepReplay, SwitchesADelayedCommandInsideARow) {
  constexpr double kRowsLate = 3.5;
  const std::uint64_t seed = 6;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(-3, 3);
  configuration::Rig rig = configuration::load_rig(std::string{CRANE_RIGS} + "/drive_axis.toml");
  rig.terms = {{"command_delay", "trolley", {{"delay_s", kRowsLate * rig.period_s}}}};
  diagnosis::Run run;
  run.period_s = rig.period_s;
  double position = 0.3, speed = 0, before_v = 0;
  const double half_s = 0.5 * rig.period_s;
  const auto accelerate = [&](double v) {
    const double acceleration = rig.plant.trolley_gain_mps2pv * v;
    position += half_s * (speed + 0.5 * half_s * acceleration);
    speed += half_s * acceleration;
  };
  for (std::size_t k = 0; k < 100; ++k) {
    run.measured[kTrolleyPosition].push_back(position);
    run.cable_m.push_back(1);
    run.command_v.push_back({any(random), 0, 0});
    accelerate(before_v);
    before_v = k < 3 ? 0 : run.command_v[k - 3][plant::kTrolley];
    accelerate(before_v);
  }
  const PreparedRun prepared = prepare(run, rig);
  const Replay replay(prepared, {rig.plant, rig.terms});
  std::vector<double> out(run.rows());
  const std::array start{0.3, 0.0};
  replay.run(Part::drive, 0, run.rows(), start, out);
  const Replay::Increments& increments = replay.increments_along_measurement(kTrolleyPosition);
  double way = 0.3, rate = 0;
  for (std::size_t k = 0; k < run.rows(); ++k) {
    ASSERT_NEAR(out[k], run.measured[kTrolleyPosition][k], 1e-9) << "seed " << seed << ", row " << k;
    ASSERT_NEAR(way, run.measured[kTrolleyPosition][k], 1e-9) << "seed " << seed << ", row " << k;
    way += run.period_s * rate + increments.distance[k];
    rate += increments.speed_change[k];
  }
}

TEST(FixedStepReplay, KnowsHowFarAnEncoderHasDriftedBeforeAWindow) {
  constexpr double kRate = 0.05;
  diagnosis::Run run = integrated(tower_with({}), 10);
  auto& measured = run.measured[kTrolleyPosition];
  double travelled_m = 0;
  const std::vector<double> true_m = measured;
  for (std::size_t k = 1; k < run.rows(); ++k) {
    travelled_m += std::abs(true_m[k] - true_m[k - 1]);
    measured[k] += kRate * travelled_m;
  }
  ASSERT_GT(kRate * travelled_m, 0.1);
  const auto rig = tower_with({{"position_drift", "trolley", {{"rate", kRate}}}});
  const PreparedRun prepared = prepare(run, rig);
  const Replay replay(prepared, {rig.plant, rig.terms});
  const std::size_t outputs = simulated_outputs(prepared, Part::drive).size(), rows = 10;
  for (std::size_t first = 0; first + rows < run.rows(); first += 90) {
    std::vector<double> out(rows * outputs);
    replay.run(Part::drive, first, rows, replay.measured_start(Part::drive, first), out);
    EXPECT_NEAR(out[0], measured[first], 1e-3) << "row " << first;
  }
}

TEST(PlainStarts, LeaveNoLargerErrorThanTheTrueMotion) {
  std::mt19937 random{20262};
  std::normal_distribution<double> noise_m{0, 0.01};
  const auto rig = tower_with({});
  diagnosis::Run run = integrated(rig, 10);
  const std::vector<double> true_m = run.measured[kTrolleyPosition];
  for (double& position : run.measured[kTrolleyPosition]) position += noise_m(random);
  Runs runs;
  runs.push_back(prepare(run, rig));
  const Problem problem(runs, Part::drive, 1, 3);
  const Fits fits = problem.fit(replays_of(runs, {rig.plant, rig.terms}));
  const std::vector<double> left = problem.squares_left(fits, 0);
  for (std::size_t w = 0; w < left.size(); ++w) {
    const Window& window = problem.windows()[w];
    double of_truth = 0;
    for (std::size_t k = window.first; k < window.first + window.rows; ++k)
      of_truth += std::pow(run.measured[kTrolleyPosition][k] - true_m[k], 2);
    // Near a standstill the sum of squares has several minima that differ by one percent.
    EXPECT_LE(left[w], 1.05 * of_truth) << "window " << w;
  }
}

TEST(FrictionStep, HoldsAnAxisBelowItsFriction) {
  const auto friction = [](double v) { return 1.0 * std::tanh(v / 0.0005); };
  FrictionStep step;
  for (int k = 0; k < 20; ++k) step = friction_step(step.speed, 0.9, 1.0, 0.005, friction);
  EXPECT_NEAR(step.speed, 0.0005 * std::atanh(0.9), 1e-6);  // creep speed of the smoothed step of friction
  EXPECT_NEAR(step.friction, 0.9, 1e-3);
}

TEST(FrictionStep, StopsAndReversesInsideOneStepAsInManySmallOnes) {
  const std::uint64_t seed = 5;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const double v = 0.05 * any(random), a = 8 * any(random), level = 1 + any(random);
    const auto friction = [level](double speed) { return level * std::tanh(speed / 0.0005) + 2 * speed; };
    const double h = 0.005;
    const FrictionStep step = friction_step(v, a, 2.0, h, friction);
    double speed = v, way = 0;
    constexpr int kFine = 20000;
    for (int k = 0; k < kFine; ++k) {
      const double dt = h / kFine, before = speed;
      speed = implicit_speed(speed + dt * a, dt * 2.0, friction);
      way += 0.5 * dt * (before + speed);
    }
    // Twice the width of the smoothed step of friction, which one step does not resolve.
    EXPECT_NEAR(step.speed, speed, 1e-3) << "seed " << seed << ", case " << i;
    EXPECT_NEAR(step.distance, way, 5e-6) << "seed " << seed << ", case " << i;
  }
}

/// The same run as the sensors report it.
Run reported(Run run, const configuration::Rig& rig) {
  plant::Model sensing(rig.plant, rig.terms, rig.period_s);
  for (std::size_t row = 0; row < run.rows(); ++row) {
    State state{.cable_m = run.cable_m[row]};
    for (const Output output : kAllOutputs) position_of(state, output) = run.measured[output][row];
    const plant::Measurement measured = sensing.measure(state);
    for (const Output output : kAllOutputs) run.measured[output][row] = measured_of(measured, output);
  }
  return run;
}

class ErrorOfTheSwingSensor : public testing::TestWithParam<plant::TermSetting> {};

/// The load pulls at the drives. A sensor error that is not inverted would change this force, and a wrong
/// payload would explain it.
TEST_P(ErrorOfTheSwingSensor, ChangesTheSimulationOfTheDrivesLessThanAnAccuratePayload) {
  constexpr double kHeavy = 4, kAccuracy = 0.02;
  auto exact = tower_with({}), lighter = exact, erroneous = tower_with({GetParam()});
  for (auto* rig : {&exact, &lighter, &erroneous}) rig->plant.load_mass_kg *= kHeavy;
  lighter.plant.load_mass_kg *= 1 - kAccuracy;
  const diagnosis::Run truth = integrated(exact, 8);
  const double by_payload = worst(truth, lighter, Part::drive),
               by_sensor = worst(reported(truth, erroneous), erroneous, Part::drive);
  EXPECT_LT(by_sensor, by_payload) << "m or rad";
}

INSTANTIATE_TEST_SUITE_P(AllKinds, ErrorOfTheSwingSensor,
                         testing::Values(plant::TermSetting{"swing_misalignment", "", {{"angle_rad", 0.36}}},
                                         plant::TermSetting{"swing_delay", "", {{"delay_s", 0.135}}},
                                         plant::TermSetting{"swing_scale", "radial", {{"factor", 1.3}}},
                                         plant::TermSetting{"swing_offset", "radial", {{"offset_rad", 0.05}}},
                                         plant::TermSetting{"swing_moving_average", "", {{"window_s", 0.2}}}),
                         [](const auto& each) { return each.param.name; });

TEST(FrictionStep, KeepsADivergedSimulationDiverged) {
  const auto friction = [](double v) { return std::tanh(v / 5e-4); };
  for (const double v : {2.75e131, -1e300, std::numeric_limits<double>::infinity()})
    EXPECT_GT(std::abs(friction_step(v, 0.0, 1.0, 0.005, friction).speed), 1e6) << v;
}

}  // namespace
}  // namespace crane::diagnosis
