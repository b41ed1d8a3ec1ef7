#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "study/study.hpp"

namespace crane::diagnosis {
namespace {

/// The step of a heavy load's pivot friction is nearly as large as the range of the parameter.
TEST(DifferenceStep, StaysWithinTheBounds) {
  FreeParameter p;
  p.low = 0, p.high = 100;
  for (const double step : {1.0, 94.0, 500.0}) {
    p.step = step;
    for (const double value : {0.0, 5.0, 15.0, 50.0, 85.0, 99.9, 100.0}) {
      const double moved = difference_step(p, value);
      EXPECT_GT(std::abs(moved), 0) << "step " << step << " at " << value;
      EXPECT_GE(value + moved, p.low) << "step " << step << " at " << value;
      EXPECT_LE(value + moved, p.high) << "step " << step << " at " << value;
    }
  }
}

/// A probe outside the range of its term would end the diagnosis. Steps grow with mass and length of the
/// load.
TEST(ProbesOfEveryCandidate, AreTermsOfTheModelForAnyLoadAndCable) {
  PreparedRun run;
  run.run.period_s = 0.01;
  run.run.command_v.resize(1000);
  run.run.cable_m.assign(1000, 1);
  for (const Output output : kAllOutputs) {
    run.run.measured[output].resize(1000);
    run.on_grid[output].resize(1000);
  }
  auto rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  std::size_t probes = 0;
  for (const double load_kg : {1e-3, 0.1, 5.0, 400.0, 6e4, 1e6})
    for (const double cable_m : {0.05, 0.5, 8.0, 60.0}) {
      rig.plant.load_mass_kg = load_kg;
      rig.start.position[plant::kHoist] = cable_m;
      for (const Candidate& candidate : candidates_for(rig, {run}))
        for (const Shape& shape : candidate.shapes)
          for (const plant::TermSetting& probe : shape.probes) {
            ++probes;
            EXPECT_THAT(plant::problems({probe}), testing::IsEmpty())
                << load_kg << " kg at " << cable_m << " m";
          }
    }
  EXPECT_GT(probes, 1000U);
}

}  // namespace
}  // namespace crane::diagnosis
