/// Size of the force that a simulation of the swing lacks.
#include "verdict/missing_force.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "crane/configuration/rig.hpp"
#include "laboratory/strange_lab.hpp"

namespace crane::diagnosis {
namespace {

configuration::Rig pendulum_rig() {
  return configuration::load_rig(std::string{CRANE_RIGS} + "/gantry.toml");
}

/// For a residual a cos(w t), the missing force is m g a (1 - w^2 / w0^2) cos(w t): of the equation
/// r'' + w0^2 r = w0^2 F / m g.
TEST(MissingForce, IsThatOfTheEquationOfAPendulum) {
  constexpr double kAmplitude_rad = 0.05, kForced_radps = 6, kNatural_radps = 2.5;
  const auto table =
      strange::recorded(strange::moved({}, 12, [](double t) { return 0.3 * std::sin(2 * t); }), {});
  const Runs runs{prepare(load_run(table, pendulum_rig(), "swing.csv").runs.at(0), pendulum_rig())};
  const Problem problem = Problem(runs, Part::load, 2, kNatural_radps).plain();
  Fits fits = problem.fit(replays_of(runs, {pendulum_rig().plant, pendulum_rig().terms}));
  for (std::size_t w = 0; w < fits.size(); ++w) {
    const Window& window = problem.windows()[w];
    fits[w].simulated = problem.measured(window);
    for (std::size_t k = 0; k < window.rows; ++k)
      fits[w].simulated[static_cast<Eigen::Index>(k)] -=
          kAmplitude_rad * std::cos(kForced_radps * runs[0].run.instant_s(window.first + k));
  }
  const double expected = kAmplitude_rad / std::sqrt(2.0) * (std::pow(kForced_radps / kNatural_radps, 2) - 1);
  // The second difference over 1/8 of a natural period underestimates a fast oscillation: sinc^2.
  const double half_span = kForced_radps * 2 * std::numbers::pi / kNatural_radps / 8 / 2;
  const double curvature = std::pow(std::sin(half_span) / half_span, 2);
  const double differenced =
      kAmplitude_rad / std::sqrt(2.0) * (curvature * std::pow(kForced_radps / kNatural_radps, 2) - 1);
  EXPECT_LT(differenced, expected);
  EXPECT_NEAR(missing_force(problem, fits, 0, kNatural_radps, 0), differenced, 0.1 * differenced);
}

TEST(MissingForce, IsZeroForASimulationThatEqualsTheMeasurement) {
  const auto table =
      strange::recorded(strange::moved({}, 12, [](double t) { return 0.3 * std::sin(2 * t); }), {});
  const Runs runs{prepare(load_run(table, pendulum_rig(), "swing.csv").runs.at(0), pendulum_rig())};
  const Problem problem = Problem(runs, Part::load, 2, 2.5).plain();
  Fits fits = problem.fit(replays_of(runs, {pendulum_rig().plant, pendulum_rig().terms}));
  for (std::size_t w = 0; w < fits.size(); ++w) fits[w].simulated = problem.measured(problem.windows()[w]);
  EXPECT_EQ(missing_force(problem, fits, 0, 2.5, 0), 0);
  EXPECT_EQ(share_not_followed(problem, fits, 0, 0), 0);
}

TEST(MissingForce, MeasuresTheNoiseOfASensorAndNotTheMotion) {
  const auto noise_of = [](double noise_rad) {
    auto table =
        strange::recorded(strange::moved({}, 60, [](double t) { return 0.3 * std::sin(2 * t); }), {});
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal(0, noise_rad);
    for (auto& column : table.columns)
      if (column.name == "swing_radial_rad")
        for (double& value : column.values) value += noise_rad > 0 ? normal(random) : 0;
    const Runs runs{prepare(load_run(table, pendulum_rig(), "swing.csv").runs.at(0), pendulum_rig())};
    return measured_noise(Problem(runs, Part::load, 2, 2.5), 0);
  };
  EXPECT_LT(noise_of(0), 1e-3);
  EXPECT_NEAR(noise_of(0.02), 0.02, 2e-3);
}

/// A coarse sensor: its noise alone would count as a force of 8 % of the weight.
TEST(MissingForce, IsNotTheNoiseOfTheSensor) {
  constexpr double kNoise_rad = 0.02, kSmall = 0.02;
  const auto table =
      strange::recorded(strange::moved({}, 60, [](double t) { return 0.3 * std::sin(2 * t); }), {});
  const Runs runs{prepare(load_run(table, pendulum_rig(), "swing.csv").runs.at(0), pendulum_rig())};
  const Problem problem = Problem(runs, Part::load, 2, 2.5).plain();
  Fits fits = problem.fit(replays_of(runs, {pendulum_rig().plant, pendulum_rig().terms}));
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, kNoise_rad);
  for (std::size_t w = 0; w < fits.size(); ++w)
    fits[w].simulated =
        problem.measured(problem.windows()[w]).unaryExpr([&](double x) { return x + noise(random); });
  EXPECT_GT(missing_force(problem, fits, 0, 2.5, 0), 0.06);
  EXPECT_LT(missing_force(problem, fits, 0, 2.5, kNoise_rad), kSmall);
  EXPECT_LT(share_not_followed(problem, fits, 0, kNoise_rad), 0.5 * share_not_followed(problem, fits, 0, 0));
}

}  // namespace
}  // namespace crane::diagnosis
