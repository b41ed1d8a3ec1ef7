/// Scenarios with whole stacks in lockstep: equal bytes for every runner and vendor, and the figures of the
/// three maneuvers of the dissertation.
#include <gtest/gtest.h>

#include <iostream>

#include "../recording/temporary_directory.hpp"
#include "experiments/experiment_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using recording::contents_of;
using recording::put_contents;
using recording::TemporaryDirectory;

constexpr std::uint32_t kDomain = 60;

/// A scenario with all actions: a move of three axes, and kicks during the move.
constexpr const char* kShort = R"(description = "a short run with everything in it"
duration_s = 2.5
[start]
trolley_position_m = 0.5
slew_angle_deg = 10
[[move]]
at_s = 0.3
trolley_position_m = 0.7
slew_angle_deg = -20
cable_length_m = 0.9
[[kick]]
at_s = 1.2
radial_degps = 5
tangential_degps = -4
)";

class Lockstep : public testing::Test {
 protected:
  void SetUp() override {
    options_.scenario = directory_ / "short.toml";
    put_contents(options_.scenario, kShort);
    options_.rig = stack::find_rig("virginia_tech_tower");
    options_.picture = false;
    options_.bus.domain = kDomain;
    options_.bus.crane = crane_name();
  }
  /// Runs the scenario again, with files in a directory of this name.
  std::filesystem::path run(const std::string& name) {
    options_.directory = directory_ / name;
    const auto result = experiments::run_experiment(options_);
    EXPECT_TRUE(result.outcome.completed) << result.outcome.stopped_because;
    return options_.directory;
  }
  std::filesystem::path run_in_process() {
    options_.in_process = true;
    const auto files = run("in_process");
    options_.in_process = false;
    return files;
  }
  static void expect_same_bytes(const std::filesystem::path& a, const std::filesystem::path& b) {
    for (const auto* file : {"run.csv", "recording.mcap"}) {
      const auto expected = contents_of(a / file);
      EXPECT_GT(expected.size(), 10'000U) << file;
      EXPECT_TRUE(expected == contents_of(b / file)) << file << " of " << a << " and " << b << " differ";
    }
  }

  TemporaryDirectory directory_;
  experiments::ExperimentOptions options_;
};

TEST_F(Lockstep, ProcessesGiveTheSameBytesTwice) { expect_same_bytes(run("first"), run("second")); }

TEST_F(Lockstep, OneProcessGivesTheSameBytesAsSeparateProcesses) {
  expect_same_bytes(run_in_process(), run("processes"));
}

TEST_F(Lockstep, FastDdsGivesTheSameBytes) {
  options_.bus.vendor = "fastdds";
  expect_same_bytes(run_in_process(), run("fastdds"));
}

TEST_F(Lockstep, AlternatingVendorsGiveTheSameBytes) {
  options_.vendors = {{"plant", "fastdds"}, {"tracking", "fastdds"}, {"friction_compensation", "fastdds"}};
  expect_same_bytes(run_in_process(), run("alternating"));
}

TEST_F(Lockstep, ACraneThatAdaptsGivesTheSameBytesInOneProcessAsInSeparateProcesses) {
  const auto tower = "extends = \"" + options_.rig.string() + "\"\nname = \"adapting\"\n";
  const auto fixed = contents_of(run_in_process() / "run.csv");
  options_.rig = directory_ / "fixed.toml";
  put_contents(options_.rig, tower + "[adaptation]\nenabled = false\n");
  EXPECT_TRUE(fixed == contents_of(run_in_process() / "run.csv"))
      << "the switch changes a run while it is off";
  options_.rig = directory_ / "adapting.toml";
  put_contents(options_.rig, tower +
                                 "[adaptation]\nenabled = true\n[controller.friction.trolley]\n"
                                 "coulomb_positive_v = 1.3\ncoulomb_negative_v = 1.6\n");
  expect_same_bytes(run_in_process(), run("processes"));
}

TEST_F(Lockstep, AnotherScenarioGivesOtherBytes) {
  const auto files = run_in_process();
  std::string text{kShort};
  text.replace(text.find("-20"), 3, "-21");
  put_contents(options_.scenario, text);
  EXPECT_FALSE(contents_of(files / "run.csv") == contents_of(run("other") / "run.csv"));
}

/// A law and a variant of the rig for which processes and one process must give equal bytes.
struct Law {
  const char *controller, *variant;
};

class LawInLockstep : public Lockstep, public testing::WithParamInterface<Law> {};

TEST_P(LawInLockstep, GivesTheSameBytesInOneProcessAsInSeparateProcesses) {
  options_.controller = GetParam().controller;
  options_.variant = GetParam().variant;
  expect_same_bytes(run_in_process(), run("processes"));
}

INSTANTIATE_TEST_SUITE_P(Laws, LawInLockstep,
                         testing::Values(Law{"lqr", ""}, Law{"lqr", "observer"}, Law{"shaped_zv", ""},
                                         Law{"shaped_zvd", ""}, Law{"shaped_ei", ""},
                                         Law{"shaped_ei", "observer"}, Law{"time_optimal", ""},
                                         Law{"time_optimal", "observer"}, Law{"fuzzy_printed", "observer"}),
                         [](const auto& law) {
                           return std::string{law.param.controller} +
                                  (*law.param.variant != 0 ? "_observer" : "");
                         });

/// Settling times of the full nonlinear model by an independent simulation of the same design.
struct Figures {
  std::string rig, controller, scenario;
  double settling_time_s;
};

std::ostream& operator<<(std::ostream& out, const Figures& figures) {
  return out << figures.rig << ", " << figures.controller << ", " << figures.scenario;
}

class Maneuvers : public testing::TestWithParam<Figures> {};

TEST_P(Maneuvers, SettleAsDesignedWithoutResidualSwing) {
  const auto& expected = GetParam();
  const TemporaryDirectory directory;
  const auto result = experiments::run_experiment({.scenario = stack::find_scenario(expected.scenario),
                                                   .rig = stack::find_rig(expected.rig),
                                                   .controller = expected.controller,
                                                   .variant = "",
                                                   .directory = directory / "run",
                                                   .in_process = true,
                                                   .picture = false,
                                                   .bus = {},
                                                   .vendors = {}});
  ASSERT_TRUE(result.outcome.completed) << result.outcome.stopped_because;
  ASSERT_TRUE(result.metrics.settling_time_s.has_value());
  std::cout << expected << ": settled after " << *result.metrics.settling_time_s << " s, expected "
            << expected.settling_time_s << " s; residual swing "
            << result.metrics.residual_swing_rad * 180 / M_PI << " deg\n";
  // Quantisation and filters of the sensors take up to 0.1 s, which the model without them does not show.
  EXPECT_NEAR(*result.metrics.settling_time_s, expected.settling_time_s, 0.1 * expected.settling_time_s);
  EXPECT_LT(result.metrics.residual_swing_rad, 0.5 * M_PI / 180);
  EXPECT_EQ(result.metrics.lost_ticks, 0U);
  if (expected.scenario == "maneuver_1" && expected.controller == "gain_scheduling_partial") {
    EXPECT_LE(result.metrics.overshoot_percent[0].value(), 1);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Dissertation, Maneuvers,
    testing::Values(Figures{"virginia_tech_tower", "gain_scheduling_partial", "maneuver_1", 3.39},
                    Figures{"virginia_tech_tower", "gain_scheduling_partial", "maneuver_2", 4.66},
                    Figures{"virginia_tech_tower", "gain_scheduling_partial", "maneuver_3", 4.88},
                    Figures{"virginia_tech_tower_ideal", "gain_scheduling_partial", "maneuver_1", 3.38},
                    Figures{"virginia_tech_tower_ideal", "gain_scheduling_partial", "maneuver_2", 4.61},
                    Figures{"virginia_tech_tower_ideal", "gain_scheduling_partial", "maneuver_3", 4.82},
                    Figures{"virginia_tech_tower", "delayed_1", "maneuver_1", 5.23}),
    [](const auto& test) {
      return test.param.rig + "_" + test.param.controller + "_" + test.param.scenario;
    });

/// Every rig file with a trolley drive can be armed and moved with the checks of its limits.
class RigOfTheProject : public testing::TestWithParam<const char*> {};

TEST_P(RigOfTheProject, CanBeArmedAndMoved) {
  const TemporaryDirectory directory;
  experiments::ExperimentOptions options;
  options.scenario = directory / "trolley.toml";
  put_contents(options.scenario, R"(description = "the trolley alone"
duration_s = 6
[start]
trolley_position_m = 0.3
[[move]]
at_s = 0.3
trolley_position_m = 0.45
)");
  options.rig = stack::find_rig(GetParam());
  options.directory = directory / "run";
  options.in_process = true;
  options.picture = false;
  const auto result = experiments::run_experiment(options);
  EXPECT_TRUE(result.outcome.completed) << result.outcome.stopped_because;
  EXPECT_LT(std::abs(result.metrics.final_error[plant::kTrolley]), 0.1) << "it has not moved";
}

INSTANTIATE_TEST_SUITE_P(Rigs, RigOfTheProject,
                         testing::Values("virginia_tech_tower", "virginia_tech_tower_ideal", "gantry",
                                         "drive_axis"),
                         [](const auto& rig) { return std::string{rig.param}; });

}  // namespace
}  // namespace crane::system_test
