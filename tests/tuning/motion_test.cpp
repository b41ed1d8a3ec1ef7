/// The motions of the tuning stay within the excursion that is predicted for the cranes of the priors.
#include "tuning/motion.hpp"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "crane/plant/coordinates.hpp"
#include "hidden_rig.hpp"
#include "tuning/lockstep_crane.hpp"

namespace crane::tuning {
namespace {

/// Largest distance of a column from `middle`.
double largest(const Motion& motion, std::size_t coordinate, double middle) {
  double found = 0;
  if (const auto* values = motion.table.find(plant::kCoordinates[coordinate].column))
    for (const double value : *values) found = std::max(found, std::abs(value - middle));
  return found;
}

/// Largest measured / predicted value of the motions of a rig.
struct Ratios {
  double swing = 0, distance = 0;
};

Ratios ratios_of(const HiddenRig& hidden, std::size_t axis, const Motion& motion,
                 const Excursion& predicted) {
  EXPECT_EQ(motion.stopped_because, "") << hidden.description;
  const auto& drive = hidden.known.drives[axis];
  Ratios ratios{
      .swing = 0,
      .distance = largest(motion, axis, (drive.low_limit + drive.high_limit) / 2) / predicted.distance};
  for (std::size_t swing = 0; swing < 2; ++swing)
    ratios.swing =
        std::max(ratios.swing, largest(motion, plant::kSwingRadial + swing, hidden.rest_angle_rad[swing]) /
                                   predicted.swing_rad);
  return ratios;
}

/// The largest probe and the main motion of each axis, on the hidden rig and in the prediction.
Ratios largest_ratios(std::uint64_t seed) {
  spdlog::set_level(spdlog::level::off);
  const auto hidden = hidden_rig(seed);
  const Priors priors;
  const auto careful = careful_rig(hidden.known, priors);
  LockstepCrane crane{hidden.truth};
  Ratios found;
  const auto take = [&found](const Ratios& of_motion) {
    found.swing = std::max(found.swing, of_motion.swing);
    found.distance = std::max(found.distance, of_motion.distance);
  };
  for (const std::size_t axis : {plant::kTrolley, plant::kSlew}) {
    if (!hidden.known.drives[axis].present) continue;
    const auto possible = possible_from(hidden.known, priors, axis);
    const auto& drive = hidden.drives[axis];
    const auto first = probe(careful, priors, axis, kProbeLevels.back(), possible);
    take(ratios_of(hidden, axis, crane.execute(careful, first),
                   largest_excursion(careful, priors, possible, first)));
    const Rough rough{.cable_m = hidden.cable_m,
                      .cable_error_m = 0,
                      .friction_v = (drive.coulomb_positive_v + drive.coulomb_negative_v) / 2};
    const auto main = main_motion(careful, priors, axis, rough);
    const auto predicted = largest_excursion(careful, priors, possible_from(rough), main);
    EXPECT_LT(predicted.swing_rad, hidden.known.limits.swing_limit_rad);
    take(ratios_of(hidden, axis, crane.execute(compensated(careful, axis, rough), main), predicted));
  }
  return found;
}

/// The prediction is that of the worst possible crane, and therefore a bound.
void expect_bounded(const Ratios& ratios) {
  EXPECT_LE(ratios.swing, 1);
  EXPECT_LE(ratios.distance, 1);
}

/// Short cables (101, 116), long cables, and both kinds of rigs.
class MotionsOfHiddenRigs : public testing::TestWithParam<int> {};

TEST_P(MotionsOfHiddenRigs, StayWithinThePrediction) {
  expect_bounded(largest_ratios(static_cast<std::uint64_t>(GetParam())));
}

TEST(Long, MotionsOfHiddenRigsStayWithinThePrediction) {
  double swing = 0, distance = 0;
  for (std::uint64_t seed = 401; seed <= 460; ++seed) {
    const auto ratios = largest_ratios(seed);
    expect_bounded(ratios);
    swing = std::max(swing, ratios.swing), distance = std::max(distance, ratios.distance);
  }
  std::cout << "largest measured / predicted: swing " << swing << ", distance " << distance << '\n';
}

INSTANTIATE_TEST_SUITE_P(Seeds, MotionsOfHiddenRigs, testing::Values(101, 116, 1, 2));

}  // namespace
}  // namespace crane::tuning
