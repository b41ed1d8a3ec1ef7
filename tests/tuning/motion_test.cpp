/// The motions of the tuning stay within the excursion that is predicted for the cranes of the priors.
#include "tuning/motion.hpp"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

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

void expect_within(const HiddenRig& hidden, std::size_t axis, const Motion& motion,
                   const Excursion& predicted) {
  EXPECT_EQ(motion.stopped_because, "") << hidden.description;
  for (std::size_t swing = 0; swing < 2; ++swing)
    EXPECT_LE(largest(motion, plant::kSwingRadial + swing, hidden.rest_angle_rad[swing]),
              predicted.swing_rad + 0.01)
        << hidden.description;
  const auto& drive = hidden.known.drives[axis];
  EXPECT_LE(largest(motion, axis, (drive.low_limit + drive.high_limit) / 2), predicted.distance + 0.005)
      << hidden.description;
}

/// Short cables (101, 116), long cables, and both kinds of rigs.
class MotionsOfHiddenRigs : public testing::TestWithParam<int> {};

TEST_P(MotionsOfHiddenRigs, StayWithinThePredictedExcursion) {
  spdlog::set_level(spdlog::level::off);
  const auto hidden = hidden_rig(static_cast<std::uint64_t>(GetParam()));
  const Priors priors;
  const auto careful = careful_rig(hidden.known, priors);
  LockstepCrane crane{hidden.truth};
  for (const std::size_t axis : {plant::kTrolley, plant::kSlew}) {
    if (!hidden.known.drives[axis].present) continue;
    const auto possible = possible_from(hidden.known, priors, axis);
    const auto& drive = hidden.drives[axis];
    const auto first = probe(careful, priors, axis, kProbeLevels.back(), possible);
    expect_within(hidden, axis, crane.execute(careful, first),
                  largest_excursion(careful, priors, possible, first));
    const Rough rough{.cable_m = hidden.cable_m,
                      .cable_error_m = 0,
                      .friction_v = (drive.coulomb_positive_v + drive.coulomb_negative_v) / 2};
    const auto main = main_motion(careful, priors, axis, rough);
    const auto predicted = largest_excursion(careful, priors, possible_from(rough), main);
    EXPECT_LT(predicted.swing_rad, hidden.known.limits.swing_limit_rad);
    expect_within(hidden, axis, crane.execute(compensated(careful, axis, rough), main), predicted);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, MotionsOfHiddenRigs, testing::Values(101, 116, 1, 2));

}  // namespace
}  // namespace crane::tuning
