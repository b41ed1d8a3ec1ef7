#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/comparison_run.hpp"
#include "stack/data_files.hpp"

namespace crane::experiment {
namespace {

/// Seconds between the first and the last upward crossing of zero, per crossing.
double swing_period_s(const std::vector<Sample>& samples, double from_s) {
  std::vector<double> crossings;
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (samples[i].time_s > from_s && samples[i - 1].swing_radial_rad < 0 && samples[i].swing_radial_rad >= 0)
      crossings.push_back(samples[i].time_s);
  return (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
}

class CableOffNominal : public testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(CableOffNominal, SwingsWithTheTrueCableWhileTheEncoderShowsTheNominalOne) {
  const auto [variant, true_length_m] = GetParam();
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower_ideal"));
  const auto scenario = parse_scenario(
      "description = \"a push\"\nduration_s = 15\n[start]\ntrolley_position_m = 0.7\n[[kick]]\nat_s = 0.5\n"
      "radial_degps = 10\n",
      "push.toml", &rig);
  const auto run = experiments::simulate({scenario, rig, control::find_controller("none"), variant});
  ASSERT_EQ(run.stopped_because, "");
  // Small swing below a trolley that the control holds: a tolerance of 1 % for the motion of the trolley and
  // the sampling.
  const double expected_s = 2 * std::numbers::pi * std::sqrt(true_length_m / rig.plant.gravity_mps2);
  EXPECT_NEAR(swing_period_s(run.samples, 1), expected_s, 0.01 * expected_s);
  for (const Sample& sample : run.samples) EXPECT_NEAR(sample.position[plant::kHoist], 1.0, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Variants, CableOffNominal,
                         testing::Values(std::pair{"as_is", 1.0}, std::pair{"short_cable", 0.5},
                                         std::pair{"long_cable", 1.5}),
                         [](const auto& test) { return std::string{test.param.first}; });

TEST(CableOffset, MustLeaveACable) {
  try {
    (void)configuration::parse_rig("extends = \"pendulum.toml\"\n[start]\ncable_length_offset_m = -1.0\n",
                                   stack::find_rig("pendulum").parent_path() / "short.toml");
    FAIL() << "a cable of no length";
  } catch (const configuration::ConfigurationError& error) {
    EXPECT_NE(error.problems().at(0).find("cable_length_offset_m = -1"), std::string::npos);
  }
}

}  // namespace
}  // namespace crane::experiment
