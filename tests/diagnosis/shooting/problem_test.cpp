/// Windows of a load: slopes before and after whitening, and the natural frequency.
#include "shooting/problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "crane/plant/pendulum.hpp"
#include "laboratory/strange_lab.hpp"
#include "study/body.hpp"

namespace crane::diagnosis {
namespace {

struct Laboratory {
  configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/gantry.toml");
  diagnosis::Run run = [this] {
    const strange::Gantry crane;
    const auto truth = strange::moved(crane, 12, [](double t) { return 0.8 * strange::rich_command(t); });
    return load_run(strange::recorded(truth, {.seed = 1}), rig, "drag.csv").runs.at(0);
  }();
  double natural_radps = plant::swing_radps(rig.plant.gravity_mps2, rig.start.position[plant::kHoist]);
};

TEST(WindowsOfALoad, HaveTheSlopesOfTheirWhitenedOutputs) {
  Laboratory lab;
  Runs runs;
  runs.push_back(prepare(std::move(lab.run), lab.rig));
  Crane crane{lab.rig.plant, lab.rig.terms};
  const Replays at = replays_of(runs, crane);
  const Problem problem = Problem(runs, Part::load, 2, lab.natural_radps).whitened_by(at);
  const Fits fits = problem.fit(at);
  const double step = 0.01;
  crane.parameters.gravity_mps2 += step;
  const Replays moved = replays_of(runs, crane);
  const auto slopes = problem.whitened({problem.plain_change(moved, fits, step)}, fits).front();
  const auto expected = problem.change(moved, fits, step);
  ASSERT_EQ(slopes.size(), expected.size());
  for (std::size_t w = 0; w < slopes.size(); ++w) {
    EXPECT_GT(expected[w].norm(), 0);
    EXPECT_LT((slopes[w] - expected[w]).norm(), 1e-9 * expected[w].norm()) << "window " << w;
  }
}

/// In shorter windows, the free start explains most of the effect of a second cable.
TEST(WindowsOfALoad, ContainAPeriodOfASlowSwing) {
  const Laboratory lab;
  Runs runs;
  runs.push_back(prepare(lab.run, lab.rig));
  for (const double period_s : {1.0, 4.0}) {
    const Body body(runs, 2 * std::numbers::pi / period_s);
    for (const Window& window : body.load.windows())
      EXPECT_NEAR(static_cast<double>(window.rows) * lab.run.period_s, std::max(2.0, period_s),
                  0.15 * period_s);
  }
}

TEST(WindowsOfALoad, SwingAtTheCableLengthOfTheirRun) {
  const Laboratory lab;
  diagnosis::Run longer = lab.run;
  for (double& cable_m : longer.cable_m) cable_m *= 4;
  Runs runs;
  runs.push_back(prepare(lab.run, lab.rig));
  runs.push_back(prepare(longer, lab.rig));
  const Problem problem(runs, Part::load, 2, lab.natural_radps);
  const std::size_t windows = problem.windows().size() / 2;
  ASSERT_GT(windows, 0U);
  for (std::size_t w = 0; w < windows; ++w)
    EXPECT_NEAR(problem.motion(0, windows + w).natural_radps, 0.5 * problem.motion(0, w).natural_radps, 1e-9)
        << "window " << w;
}

}  // namespace
}  // namespace crane::diagnosis
