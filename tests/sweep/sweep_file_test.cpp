#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "stack/data_files.hpp"
#include "sweep/draw.hpp"
#include "sweep/sweep.hpp"

namespace crane::sweep {
namespace {

using configuration::ConfigurationError;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr Finder kInstalled{stack::find_rig, stack::find_scenario};

Sweep parsed(const std::string& text) { return parse_sweep(text, "dir/some.toml", kInstalled); }

std::vector<std::string> problems_of(const std::string& text) {
  try {
    (void)parsed(text);
  } catch (const ConfigurationError& error) {
    return error.problems();
  }
  return {};
}

constexpr const char* kLoad = R"(
[[draw]]
key = "plant.load_mass_kg"
low = 1.0
high = 3.0
)";

TEST(SweepFile, CountsScenariosRigsVariantsControllersAndSeeds) {
  const auto sweep = parsed(std::string{R"(
scenarios = ["maneuver_1", "maneuver_3"]
rigs = ["virginia_tech_tower", "virginia_tech_tower_ideal"]
variants = ["as_is", "observer", "short_cable"]
controllers = ["gain_scheduling_partial", "delayed_1"]
seeds = 5
)"} + kLoad);
  EXPECT_EQ(sweep.name, "some");
  EXPECT_EQ(sweep.size(), 2U * 2 * 3 * 2 * 5);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    const sweep::Run run = run_of(sweep, i);
    EXPECT_EQ(run.number, i);
    seen.insert(run.on->scenario.name + run.on->rig.name + run.variant + run.controller +
                std::to_string(run.seed));
  }
  EXPECT_EQ(seen.size(), sweep.size()) << "every combination once";
}

TEST(SweepFile, TakesTheRigsControllerAndRigWithoutLists) {
  const auto sweep = parsed("scenarios = [\"maneuver_1\"]");
  EXPECT_EQ(sweep.size(), 1U);
  const sweep::Run run = run_of(sweep, 0);
  EXPECT_EQ(run.controller, "gain_scheduling_partial");
  EXPECT_EQ(run.on->rig.name, "virginia_tech_tower");
  EXPECT_EQ(sweep.integrator, simulator::Method::cvode);
  EXPECT_EQ(parsed("scenarios = [\"maneuver_1\"]\nintegrator = \"fast\"").integrator,
            simulator::Method::fast);
}

TEST(SweepFile, AcceptsTheWordAllForAllControllers) {
  EXPECT_EQ(parsed("scenarios = [\"maneuver_1\"]\ncontrollers = [\"all\"]").controllers.size(),
            control::controllers().size());
}

TEST(SweepFile, ASeedDrawsTheSameCraneForEveryControllerAndVariant) {
  const auto sweep = parsed(std::string{R"(
scenarios = ["maneuver_1"]
controllers = ["gain_scheduling_partial", "delayed_1"]
variants = ["as_is", "no_compensation"]
first_seed = 7
seeds = 3
)"} + kLoad);
  for (std::size_t i = 3; i < sweep.size(); ++i) {
    EXPECT_EQ(run_of(sweep, i).seed, run_of(sweep, i - 3).seed);
    EXPECT_EQ(run_of(sweep, i).drawn, run_of(sweep, i - 3).drawn);
  }
  EXPECT_EQ(run_of(sweep, 0).seed, 7U);
  EXPECT_NE(run_of(sweep, 0).drawn, run_of(sweep, 1).drawn);
  const sweep::Run run = run_of(sweep, 1);
  const auto rig = rig_at_start(sweep, run);
  EXPECT_EQ(rig.plant.load_mass_kg, run.drawn[0]) << "the true crane";
  EXPECT_EQ(rig.design.crane.load_mass_kg, 2.0) << "what the controllers believe";
}

TEST(SweepFile, DrawsParametersOfTermsAlsoWhereTheyHaveTheirDefault) {
  const auto sweep = parsed(R"(
scenarios = ["maneuver_1"]
seeds = 2
[[draw]]
key = "model.terms.drive_friction.trolley.coulomb_positive_v"
low = 0.6
high = 0.7
[[draw]]
key = "model.terms.drive_friction.slew.stiction_positive_v"
low = 0.1
high = 0.2
)");
  const sweep::Run run = run_of(sweep, 1);
  auto rig = rig_at_start(sweep, run);
  EXPECT_EQ(*number_of(rig, sweep.draws[0].key).value, run.drawn[0]);
  EXPECT_EQ(*number_of(rig, sweep.draws[1].key).value, run.drawn[1]);
  EXPECT_GE(run.drawn[0], 0.6);
  EXPECT_LT(run.drawn[0], 0.7);
}

/// Kolmogorov's distance of 4000 numbers to the uniform distribution: 1.95 / sqrt(n) has the level 0.001.
TEST(SweepFile, DrawsAreUniformAndIndependent) {
  constexpr std::size_t kCount = 4000;
  std::vector<double> all;
  double product = 0;
  for (std::uint64_t seed = 0; seed < kCount; ++seed) {
    all.push_back(uniform(seed, 0));
    product += (uniform(seed, 0) - 0.5) * (uniform(seed, 1) - 0.5);
  }
  std::sort(all.begin(), all.end());
  double distance = 0;
  for (std::size_t i = 0; i < kCount; ++i)
    distance = std::max(distance, std::abs(all[i] - static_cast<double>(i) / kCount));
  EXPECT_LT(distance, 1.95 / std::sqrt(kCount));
  EXPECT_LT(std::abs(product / kCount * 12), 3.3 / std::sqrt(kCount)) << "correlation, level 0.001";
}

TEST(SweepFile, ReportsAllProblemsAtOnceWithFileNameValueAndRule) {
  const auto problems = problems_of(R"(
scenarios = ["maneuver_1", "maneuver_1", "maneuver_99"]
controllers = ["nobody"]
variants = ["fast_cable"]
integrator = "euler"
seeds = 0
sedes = 3
[[draw]]
key = "plant.load_mass_kg"
low = 3.0
high = 1.0
)");
  EXPECT_THAT(problems, Contains(HasSubstr("dir/some.toml:2: scenarios")));
  EXPECT_THAT(problems, Contains(HasSubstr("has maneuver_1 twice")));
  EXPECT_THAT(problems, Contains(HasSubstr("scenario = maneuver_99: must be a file, or one of")));
  EXPECT_THAT(problems, Contains(HasSubstr("no controller has the name nobody")));
  EXPECT_THAT(problems, Contains(HasSubstr("variant \"fast_cable\": must be one of")));
  EXPECT_THAT(problems, Contains(HasSubstr("integrator = \"euler\"")));
  EXPECT_THAT(problems, Contains(HasSubstr("seeds = 0")));
  EXPECT_THAT(problems, Contains(HasSubstr("sedes")));
  EXPECT_THAT(problems, Contains(HasSubstr("must be below high")));
}

TEST(SweepFile, RefusesContradictions) {
  EXPECT_THAT(problems_of("scenarios = [\"maneuver_1\"]\nseeds = 10"),
              ElementsAre(HasSubstr("every seed would give the same run")));
  EXPECT_THAT(problems_of("description = \"nothing\""), Contains(HasSubstr("at least one scenario")));
  EXPECT_THAT(problems_of("scenarios = []"), Contains(HasSubstr("must not be empty")));
  EXPECT_THAT(problems_of(std::string{"scenarios = [\"maneuver_1\"]"} + kLoad + kLoad),
              ElementsAre(HasSubstr("has a [[draw]] already")));
}

TEST(SweepFile, RefusesDrawsThatTheRigCannotHave) {
  EXPECT_THAT(problems_of(R"(
scenarios = ["maneuver_1"]
[[draw]]
key = "plant.loadmass"
low = 1.0
high = 2.0
[[draw]]
key = "model.terms.load_linear_drag.coefficient_nspm"
low = 0.0
high = 0.1
[[draw]]
key = "plant.jib_inertia_kgm2"
low = -1.0
high = 2.0
)"),
              ElementsAre(HasSubstr("plant.loadmass: the rig virginia_tech_tower has no such number"),
                          HasSubstr("load_linear_drag"), HasSubstr("jib_inertia_kgm2 = -1"),
                          HasSubstr("jib_inertia_kgm2 = -1")));
}

TEST(SweepFile, AllInstalledSweepsAreValid) {
  EXPECT_GE(load_sweep(stack::find_sweep("friction_and_load"), kInstalled).size(), 1000U);
}

}  // namespace
}  // namespace crane::sweep
