/// Least squares for a motion with known friction: exact without noise, correct standard errors with noise,
/// and no result when the data do not determine it.
#include "crane/identification/friction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include "crane/identification/test_problem.hpp"

namespace crane::identification {
namespace {

constexpr double kTestGain = 1.7;

AxisRun held_run(double duration_s = 60) {
  TestProblem problem;
  problem.held = true;
  problem.duration_s = duration_s;
  AxisRun run = simulate(problem);
  run.speed.clear();
  return run;
}

FrictionOptions unfiltered(double zero_band, std::optional<double> gain = kTestGain) {
  FrictionOptions options;
  options.zero_band = zero_band;
  options.cutoff_ratio = 0;
  options.gain = gain;
  return options;
}

/// The rows fulfil u = a/K_m + b v + c exactly: least squares must return these values.
AxisRun constructed_run(double viscous_positive, double viscous_negative, double coulomb_positive,
                        double coulomb_negative) {
  AxisRun run;
  run.position = {0, 1e-3};
  run.drive_v = {};
  const double t = run.period_s;
  for (int k = 2; k < 1000; ++k) {
    const double x0 = run.position[static_cast<std::size_t>(k - 2)];
    const double x1 = run.position[static_cast<std::size_t>(k - 1)];
    const double u = 6 * std::sin(0.01 * k) + 3 * std::sin(0.017 * k);
    // Solves a = K (u - f(v)) with v = (x2 - x0)/2T for x2. The assumed direction of motion must agree with
    // the sign of the resulting v.
    double x2 = 0;
    for (const double sign : {1.0, -1.0}) {
      const double b = sign > 0 ? viscous_positive : viscous_negative;
      const double c = sign > 0 ? coulomb_positive : coulomb_negative;
      x2 = (kTestGain * t * t * (u - sign * c) + kTestGain * b * t / 2 * x0 + 2 * x1 - x0) /
           (1 + kTestGain * b * t / 2);
      if ((x2 - x0) * sign > 0) break;
    }
    run.position.push_back(x2);
    if (run.drive_v.size() < 2) run.drive_v.assign(2, u);
    run.drive_v[static_cast<std::size_t>(k - 1)] = 2 * u - run.drive_v[static_cast<std::size_t>(k - 2)];
    run.drive_v.push_back(0);
  }
  return run;
}

TEST(Friction, IsFoundToRoundingWhereTheRowsAreExact) {
  const auto e = estimate_friction(constructed_run(1.5, 6, 0.9, 1.2), unfiltered(0.05));
  // Second differences of numbers of size 1 over 1e-4 s^2 leave 1e-12 per row.
  EXPECT_NEAR(e.viscous_positive.value, 1.5, 1e-9);
  EXPECT_NEAR(e.viscous_negative.value, 6, 1e-9);
  EXPECT_NEAR(e.coulomb_positive.value, 0.9, 1e-9);
  EXPECT_NEAR(e.coulomb_negative.value, 1.2, 1e-9);
  EXPECT_LT(e.residual_rms_v, 1e-9);
}

TEST(Friction, OfTheTestProblemIsUnbiasedInTheMidpointForm) {
  for (const double zero_band : {0.02, 0.05, 0.1}) {
    const auto e = estimate_friction(held_run(), unfiltered(zero_band));
    EXPECT_NEAR(e.viscous_positive.value, 2.8, 3e-4);  // 2.8001: speeds are differences over two periods
    EXPECT_NEAR(e.viscous_negative.value, 5.5, 3e-4);
    EXPECT_NEAR(e.coulomb_positive.value, 1.0, 3e-4);
    EXPECT_NEAR(e.coulomb_negative.value, 1.2, 3e-4);
    EXPECT_EQ(e.gain.value, kTestGain);
    EXPECT_EQ(e.gain.standard_error, 0);
    EXPECT_GT(e.rows_positive + e.rows_negative, 1000U);
  }
}

TEST(Friction, LosesItsBiasOnlyWithTheMidpointForm) {
  auto options = unfiltered(0.05);
  options.regression = Regression::dissertation;
  const auto e = estimate_friction(held_run(), options);
  EXPECT_GT(e.viscous_positive.value, 2.8 * 1.005);
  EXPECT_GT(e.viscous_negative.value, 5.5 * 1.001);
}

TEST(Friction, AndTheGainAreFoundTogetherWithAnAcceleratingReference) {
  const auto e = estimate_friction(held_run(), unfiltered(0.05, std::nullopt));
  EXPECT_NEAR(e.gain.value, kTestGain, 1e-3 * kTestGain);
  EXPECT_NEAR(e.viscous_positive.value, 2.8, 0.005);
  EXPECT_NEAR(e.coulomb_negative.value, 1.2, 0.005);
}

TEST(Friction, HardlyDependsOnASmallErrorOfTheGain) {
  const auto e = estimate_friction(held_run(), unfiltered(0.05, 1.05 * kTestGain));
  EXPECT_NEAR(e.viscous_positive.value, 2.8, 0.05 * 2.8);
  EXPECT_NEAR(e.coulomb_positive.value, 1.0, 0.05);
}

/// 60 runs with unmeasured volts of correlation time 0.2 s and with position noise: errors of the estimates
/// in units of their standard errors.
TEST(Friction, HasStandardErrorsThatHoldUnderColouredNoise) {
  constexpr std::uint64_t kSeed = 20260117;
  constexpr int kRuns = 60;
  std::cout << "seed " << kSeed << '\n';
  std::mt19937_64 random{kSeed};
  std::normal_distribution<double> normal;
  const AxisRun clean = held_run(40);
  const double expected[4]{2.8, 5.5, 1.0, 1.2};
  double squares[4]{};
  for (int i = 0; i < kRuns; ++i) {
    AxisRun run = clean;
    double disturbance = 0;
    for (std::size_t k = 0; k < run.position.size(); ++k) {
      disturbance = 0.95 * disturbance + 0.02 * normal(random);
      run.drive_v[k] += disturbance;
      run.position[k] += 2e-6 * normal(random);
    }
    FrictionOptions options;
    options.gain = kTestGain;
    const auto e = estimate_friction(run, options);
    const Estimate* const found[4]{&e.viscous_positive, &e.viscous_negative, &e.coulomb_positive,
                                   &e.coulomb_negative};
    for (int j = 0; j < 4; ++j)
      squares[j] += std::pow((found[j]->value - expected[j]) / found[j]->standard_error, 2) / kRuns;
  }
  for (const double mean_square : squares) {
    std::cout << "rms distance in standard errors: " << std::sqrt(mean_square) << '\n';
    // The expected value is 1 for exact standard errors; the finite numbers of runs (60) and blocks (20)
    // scatter it by 0.09 each.
    EXPECT_GT(std::sqrt(mean_square), 0.7);
    EXPECT_LT(std::sqrt(mean_square), 1.4);
  }
}

struct BadRun {
  const char* name;
  std::function<void(AxisRun&)> spoil;
  const char* says;
};

class FrictionOfBadData : public testing::TestWithParam<BadRun> {};

TEST_P(FrictionOfBadData, IsRefusedWithTheReason) {
  AxisRun run = held_run(20);
  GetParam().spoil(run);
  try {
    (void)estimate_friction(run, unfiltered(0.05));
    FAIL() << "an answer was given";
  } catch (const IdentificationError& error) {
    EXPECT_NE(std::string{error.what()}.find(GetParam().says), std::string::npos) << error.what();
  }
}

void move(AxisRun& run, const std::function<double(double)>& position) {
  for (std::size_t k = 0; k < run.position.size(); ++k)
    run.position[k] = position(static_cast<double>(k) * run.period_s);
}

INSTANTIATE_TEST_SUITE_P(
    Each, FrictionOfBadData,
    testing::Values(
        BadRun{"TooShort",
               [](AxisRun& run) {
                 run.position.resize(99);
                 run.drive_v.resize(99);
               },
               "only 99 samples"},
        BadRun{"OfDifferentLengths", [](AxisRun& run) { run.drive_v.pop_back(); }, "differ in length"},
        BadRun{"NotFinite", [](AxisRun& run) { run.position[700] = std::nan(""); }, "not finite"},
        BadRun{"WithoutVoltage", [](AxisRun& run) { run.drive_v.assign(run.drive_v.size(), 1.5); },
               "voltage is constant"},
        BadRun{"AtRest", [](AxisRun& run) { move(run, [](double) { return 0.3; }); }, "zero-velocity band"},
        BadRun{"InOneDirection",
               [](AxisRun& run) {
                 move(run, [](double at_s) { return 0.3 * at_s + 0.05 * std::sin(2 * at_s); });
               },
               "0 samples move in the negative direction"},
        BadRun{"AtOneSpeed",
               [](AxisRun& run) {
                 move(run, [](double at_s) { return 0.2 * std::abs(std::fmod(at_s, 4) - 2); });
               },
               "one speed only"}),
    [](const auto& test) { return test.param.name; });

TEST(Friction, DoesNotEstimateTheGainWithoutAcceleration) {
  AxisRun run;  // the motion is so slow that a/K_m is below the noise of the encoder
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> rounding{-1e-6, 1e-6};
  for (int k = 0; k < 6000; ++k) {
    const double t = k * run.period_s, w = 0.2;
    const double v = 0.3 * w * std::cos(w * t);
    run.position.push_back(0.3 * std::sin(w * t) + rounding(random));
    run.drive_v.push_back(2 * v + (v > 0 ? 1.0 : -1.0) + 1000 * rounding(random));
  }
  FrictionOptions options;
  options.zero_band = 0.01;
  EXPECT_THROW((void)estimate_friction(run, options), IdentificationError);
  options.gain = 2;
  EXPECT_NEAR(estimate_friction(run, options).coulomb_positive.value, 1.0, 0.02);
}

TEST(Friction, WithTheWrongSignOfVoltageIsAContradiction) {
  AxisRun run = held_run(20);
  EXPECT_TRUE(contradictions(estimate_friction(run, unfiltered(0.05))).empty());
  for (double& volts : run.drive_v) volts = -volts;
  EXPECT_GE(contradictions(estimate_friction(run, unfiltered(0.05))).size(), 3U);
}

TEST(Friction, RefusesOptionsOutOfTheirRange) {
  const AxisRun run = held_run(20);
  EXPECT_THROW((void)estimate_friction(run, unfiltered(-1)), std::invalid_argument);
  EXPECT_THROW((void)estimate_friction(run, unfiltered(0.05, 0.0)), std::invalid_argument);
  auto options = unfiltered(0.05);
  options.cutoff_ratio = 0.5;
  EXPECT_THROW((void)estimate_friction(run, options), std::invalid_argument);
}

}  // namespace
}  // namespace crane::identification
