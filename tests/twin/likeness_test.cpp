// Friction and gain of a drive have similar effects in a few seconds of motion: the twin distinguishes them.
#include <gtest/gtest.h>

#include <algorithm>

#include "crane/twin/hypothesis.hpp"
#include "crane/twin/twin.hpp"
#include "simulated_motion.hpp"

namespace crane::test {
namespace {

configuration::Rig rig_of(const std::string& name) {
  return configuration::load_rig(CRANE_RIGS "/" + name + ".toml");
}

/// Cause in the first event after the crane has changed by `change`; "" without an event.
std::string named_cause(const plant::TermSetting& change, std::uint64_t seed) {
  constexpr long kSecond = 100;  // ticks
  static const configuration::Rig kRig = rig_of("virginia_tech_tower");
  SimulatedMotion motion{kRig, seed};
  twin::Twin twin{kRig};
  // Duration as in bench_twin, so that the continuation of these seeds is known.
  for (long k = 0; k < (45 + static_cast<long>(seed % 7)) * kSecond; ++k) twin.step(motion.next());
  motion.become_with(change);
  for (long k = 0; k < 40 * kSecond; ++k) {
    twin.step(motion.next());
    if (twin.take_notice()) return twin.judgement().cause;
  }
  return "";
}

class Likeness : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Likeness, LessFrictionIsNotNamedAsGain) {
  EXPECT_EQ(named_cause({"coulomb_friction", "trolley", {{"level_v", -0.1}}}, GetParam()),
            "coulomb_friction");
}

TEST_P(Likeness, LessGainIsNotNamedAsFriction) {
  EXPECT_EQ(named_cause({"motor_gain", "trolley", {{"factor", 0.9}}}, GetParam()), "motor_gain");
}

// Moves in which both causes have nearly equal effects.
INSTANTIATE_TEST_SUITE_P(Seed, Likeness, testing::Values(5, 7, 9, 13), testing::PrintToStringParamName());

/// Levels of dry friction for an axis, V.
std::vector<double> levels(const configuration::Rig& rig, const std::string& axis) {
  std::vector<double> all;
  for (const twin::Hypothesis& h : twin::hypotheses_for(rig))
    if (h.cause == "coulomb_friction" && h.axis == axis) all.push_back(h.reference);
  return all;
}

TEST(Hypotheses, TakeNoFrictionFromAnAxisThatHasNone) {
  EXPECT_EQ(levels(rig_of("virginia_tech_tower_ideal"), "trolley"), (std::vector{0.1, 0.2, 0.4}));
}

TEST(Hypotheses, TakeNotMoreFrictionThanAnAxisHas) {
  configuration::Rig rig = rig_of("virginia_tech_tower");
  for (plant::TermSetting& term : rig.terms)
    term.parameters["coulomb_positive_v"] = term.parameters["coulomb_negative_v"] = 0.25;
  EXPECT_EQ(levels(rig, "slew"), (std::vector{0.1, -0.1, 0.2, -0.15, 0.4}));
}

}  // namespace
}  // namespace crane::test
