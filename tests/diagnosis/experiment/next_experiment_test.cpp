#include "experiment/next_experiment.hpp"

#include <gmock/gmock.h>

#include "crane/experiment/scenario.hpp"
#include "experiment/safe_run.hpp"

namespace crane::diagnosis {
namespace {

/// Typical noise model: noise of an encoder, and a force with a correlation time of 0.5 s.
const Disturbances kDisturbances{{{.noise = 1e-5, .acceleration = 0.04, .correlation_s = 0.5},
                                  {.noise = 1e-5, .acceleration = 0.04, .correlation_s = 0.5},
                                  {.noise = 1e-4, .acceleration = 0.05, .correlation_s = 0.5},
                                  {.noise = 1e-4, .acceleration = 0.05, .correlation_s = 0.5}}};

/// A rig and its candidates.
struct Suspects {
  explicit Suspects(const std::string& name)
      : rig(configuration::load_rig(std::filesystem::path{CRANE_RIGS} / (name + ".toml"))),
        candidates(
            candidates_for(rig, {*safe_run(rig, Crane{rig.plant, rig.terms}, motion_menu(rig).front())})) {}

  [[nodiscard]] const Candidate& find(const std::string& cause, const std::string& axis) const {
    for (const Candidate& c : candidates)
      if (c.cause == cause && c.axis == axis) return c;
    throw std::runtime_error(cause + " is no candidate");
  }
  [[nodiscard]] std::optional<NextExperiment> propose(const Effects& a, const Effects& b) const {
    return propose_experiment(rig, a, b, kDisturbances);
  }
  /// @param value of the first parameter; the others have no effect
  [[nodiscard]] Effect effect(const std::string& cause, const std::string& axis, double value) const {
    const Candidate& candidate = find(cause, axis);
    std::vector<double> values;
    for (const FreeParameter& p : candidate.parameters) values.push_back(p.null);
    values[0] = value;
    return {&candidate, values};
  }

  configuration::Rig rig;
  std::vector<Candidate> candidates;
};

TEST(NextExperiment, SeparatesADelayFromALag) {
  const Suspects tower("virginia_tech_tower");
  const auto proposed = tower.propose({tower.effect("command_delay", "trolley", 0.03)},
                                      {tower.effect("actuator_lag", "trolley", 0.03)});
  ASSERT_TRUE(proposed);
  // Two frequencies on the trolley separate the causes.
  EXPECT_EQ(proposed->name, "shaking_trolley");
  EXPECT_GT(proposed->separation, 20);
  EXPECT_NO_THROW((void)experiment::parse_scenario(proposed->scenario, "next.toml", &tower.rig));
}

/// The base model has no effect and therefore no value to fit.
TEST(NextExperiment, SeparatesACauseFromTheBaseModel) {
  const Suspects tower("virginia_tech_tower");
  const auto proposed = tower.propose({tower.effect("command_delay", "trolley", 0.03)}, {});
  ASSERT_TRUE(proposed);
  EXPECT_GT(proposed->separation, 20);
}

TEST(NextExperiment, IgnoresCommonCauses) {
  const Suspects tower("virginia_tech_tower");
  const Effect friction = tower.effect("viscous_friction", "slew", 0.3);
  const auto proposed = tower.propose({friction, tower.effect("command_delay", "trolley", 0.03)},
                                      {friction, tower.effect("actuator_lag", "trolley", 0.03)});
  ASSERT_TRUE(proposed);
  EXPECT_EQ(proposed->name, "shaking_trolley");
}

TEST(NextExperiment, SeparatesATiltedJibFromASwingOffset) {
  const Suspects gantry("gantry");
  const auto proposed =
      gantry.propose({gantry.effect("jib_tilt", "", 0.02)}, {gantry.effect("swing_offset", "radial", 0.02)});
  ASSERT_TRUE(proposed);
  EXPECT_GT(proposed->separation, 20);
}

TEST(NextExperiment, IsNotProposedForEqualHypotheses) {
  const Suspects axis("drive_axis");
  const Effect lag = axis.effect("actuator_lag", "trolley", 0.03);
  const Candidate same = *lag.candidate;
  const auto proposed = axis.propose({lag}, {{&same, {0.05, 0}}});
  EXPECT_FALSE(proposed) << "refitted, it is the same crane, not " << proposed->separation << " away in "
                         << proposed->name;
}

TEST(NextExperiment, IsRepeatable) {
  const Suspects axis("drive_axis");
  const Effects a{axis.effect("command_delay", "trolley", 0.03)},
      b{axis.effect("actuator_lag", "trolley", 0.03)};
  const auto one = axis.propose(a, b), other = axis.propose(a, b);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->name, other->name);
  EXPECT_EQ(one->separation, other->separation);
}

}  // namespace
}  // namespace crane::diagnosis
