#include "experiment/next_experiment.hpp"

#include <gmock/gmock.h>

#include "crane/experiment/scenario.hpp"
#include "experiment/safe_run.hpp"

namespace crane::diagnosis {
namespace {

/// As learnt from such rigs: an encoder's noise and a force that changes within half a second.
const Disturbances kDisturbances{{{.noise = 1e-5, .acceleration = 0.04, .correlation_s = 0.5},
                                  {.noise = 1e-5, .acceleration = 0.04, .correlation_s = 0.5},
                                  {.noise = 1e-4, .acceleration = 0.05, .correlation_s = 0.5},
                                  {.noise = 1e-4, .acceleration = 0.05, .correlation_s = 0.5}}};

/// A rig and everything that can be wrong with it.
struct Suspects {
  explicit Suspects(const std::string& name)
      : rig(runtime::load_rig(std::filesystem::path{CRANE_RIGS} / (name + ".toml"))),
        candidates(
            candidates_for(rig, {*safe_run(rig, Crane{rig.plant, rig.terms}, motion_menu(rig).front())})) {}

  [[nodiscard]] const Candidate& find(const std::string& cause, const std::string& axis) const {
    for (const Candidate& c : candidates)
      if (c.cause == cause && c.axis == axis) return c;
    throw std::runtime_error(cause + " is no candidate");
  }
  [[nodiscard]] std::optional<NextExperiment> propose(const Candidate& a, double value_a, const Candidate& b,
                                                      double value_b) const {
    return propose_experiment(rig, a, first_of(a, value_a), b, first_of(b, value_b), kDisturbances);
  }
  /// The first parameter as given, the others without effect.
  static std::vector<double> first_of(const Candidate& candidate, double value) {
    std::vector<double> values;
    for (const FreeParameter& p : candidate.parameters) values.push_back(p.null);
    values[0] = value;
    return values;
  }

  runtime::Rig rig;
  std::vector<Candidate> candidates;
};

TEST(NextExperiment, TellsADelayFromALag) {
  const Suspects tower("virginia_tech_tower");
  const auto proposed = tower.propose(tower.find("command_delay", "trolley"), 0.03,
                                      tower.find("actuator_lag", "trolley"), 0.03);
  ASSERT_TRUE(proposed);
  // Amplitude at two frequencies separates them, and only the trolley shows either.
  EXPECT_EQ(proposed->name, "shaking_trolley");
  EXPECT_GT(proposed->separation, 20);
  EXPECT_NO_THROW((void)experiment::parse_scenario(proposed->scenario, "next.toml", &tower.rig));
}

TEST(NextExperiment, TellsATiltedJibFromASwingOffset) {
  const Suspects gantry("gantry");
  const auto proposed =
      gantry.propose(gantry.find("jib_tilt", ""), 0.02, gantry.find("swing_offset", "radial"), 0.02);
  ASSERT_TRUE(proposed);
  EXPECT_GT(proposed->separation, 20);
}

TEST(NextExperiment, SaysNothingWhereBothAreTheSame) {
  const Suspects axis("drive_axis");
  const auto& lag = axis.find("actuator_lag", "trolley");
  const auto proposed = axis.propose(lag, 0.03, lag, 0.05);
  EXPECT_FALSE(proposed) << "refitted, it is the same crane, not " << proposed->separation << " away in "
                         << proposed->name;
}

TEST(NextExperiment, IsTheSameTwice) {
  const Suspects axis("drive_axis");
  const auto& a = axis.find("command_delay", "trolley");
  const auto& b = axis.find("actuator_lag", "trolley");
  const auto one = axis.propose(a, 0.03, b, 0.03), other = axis.propose(a, 0.03, b, 0.03);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->name, other->name);
  EXPECT_EQ(one->separation, other->separation);
}

}  // namespace
}  // namespace crane::diagnosis
