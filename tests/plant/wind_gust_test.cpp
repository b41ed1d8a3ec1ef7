#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "crane/plant/model.hpp"
#include "lagrange_oracle.hpp"

namespace crane::plant {
namespace {

constexpr double kTick_s = 0.01, kDrag_ns2pm2 = 0.02, kMean_mps = 10;

TermSetting wind(double mean_mps, double scatter_mps, double length_m, double seed = 1,
                 double direction_rad = 0) {
  return {"wind_gust",
          "",
          {{"coefficient_ns2pm2", kDrag_ns2pm2},
           {"mean_mps", mean_mps},
           {"scatter_mps", scatter_mps},
           {"length_m", length_m},
           {"direction_rad", direction_rad},
           {"seed", seed}}};
}

/// The force of the wind on a resting load below a braked support, along the jib.
double force_along_n(const Model& model) {
  Actuation held;
  held.locks.axis = {true, true, true};
  const State rest{.trolley_m = 1, .cable_m = 1};
  return -model.accelerations(rest, held).radial_radps2 * model.parameters().load_mass_kg;
}

/// Speed of the wind in every tick.
std::vector<double> speeds_mps(const TermSetting& setting, std::size_t ticks) {
  Model model{Parameters{}, {setting}, kTick_s};
  std::vector<double> speeds;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    model.begin_tick();
    speeds.push_back(std::sqrt(force_along_n(model) / kDrag_ns2pm2));
  }
  return speeds;
}

TEST(WindGust, InStillAirIsTheQuadraticDragOfTheLoad) {
  std::mt19937 random{test::kSeed};
  std::cout << "seed " << test::kSeed << '\n';
  const Model still{{}, {wind(0, 3, 20)}};
  const Model drag{{}, {{"load_quadratic_drag", "", {{"coefficient_ns2pm2", kDrag_ns2pm2}}}}};
  for (int i = 0; i < 100; ++i) {
    const State state = test::random_state(random);
    EXPECT_EQ(test::values(still.accelerations(state, {})), test::values(drag.accelerations(state, {})));
  }
}

TEST(WindGust, PushesTheLoadWithTheDragOfTheMeanWindWhateverTheSlewAngle) {
  constexpr double kLeft = std::numbers::pi / 2;
  const Model across{{}, {wind(kMean_mps, 0, 20, 1, kLeft)}};
  Actuation held;
  held.locks.axis = {true, true, true};
  const double force_n = kDrag_ns2pm2 * kMean_mps * kMean_mps, mass_kg = Parameters{}.load_mass_kg;
  const State rest{.trolley_m = 1, .slew_rad = 0, .cable_m = 1};
  EXPECT_NEAR(across.accelerations(rest, held).tangential_radps2, force_n / mass_kg, 1e-12);
  const State turned{.trolley_m = 1, .slew_rad = kLeft, .cable_m = 1};
  EXPECT_NEAR(across.accelerations(turned, held).radial_radps2, -force_n / mass_kg, 1e-12);
}

TEST(WindGust, HasTheVarianceAndTheCorrelationOfTheDrydenModel) {
  constexpr double kScatter_mps = 1, kLength_m = 5;
  constexpr double kCorrelation_s = kLength_m / kMean_mps, kDuration_s = 10'000;
  const std::vector<double> speed =
      speeds_mps(wind(kMean_mps, kScatter_mps, kLength_m), static_cast<std::size_t>(kDuration_s / kTick_s));
  const auto count = static_cast<double>(speed.size());
  double mean = 0;
  for (const double v : speed) mean += v / count;
  const auto covariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t k = lag; k < speed.size(); ++k) sum += (speed[k] - mean) * (speed[k - lag] - mean);
    return sum / count;
  };
  // Independent values in the record: duration / (2 correlation times). Four standard deviations of each.
  const double independent = kDuration_s / (2 * kCorrelation_s);
  EXPECT_NEAR(mean, kMean_mps, 4 * kScatter_mps / std::sqrt(independent));
  const double tolerance = 4 * kScatter_mps * kScatter_mps * std::sqrt(2 / independent);
  for (const double lag_s : {0.0, 0.1, 0.5, 1.5})
    EXPECT_NEAR(covariance(static_cast<std::size_t>(lag_s / kTick_s)),
                kScatter_mps * kScatter_mps * std::exp(-lag_s / kCorrelation_s), tolerance)
        << "lag " << lag_s << " s";
}

TEST(WindGust, RepeatsItselfWithTheSameSeedAndDiffersWithAnother) {
  const auto first = speeds_mps(wind(kMean_mps, 2, 20, 7), 200);
  EXPECT_EQ(first, speeds_mps(wind(kMean_mps, 2, 20, 7), 200));
  EXPECT_NE(first, speeds_mps(wind(kMean_mps, 2, 20, 8), 200));
}

TEST(WindGust, IsTheMeanWindForAModelThatPredicts) {
  const Model predicting{Parameters{}, {wind(kMean_mps, 2, 20)}, kTick_s};
  EXPECT_NEAR(force_along_n(predicting), kDrag_ns2pm2 * kMean_mps * kMean_mps, 1e-12);
}

}  // namespace
}  // namespace crane::plant
