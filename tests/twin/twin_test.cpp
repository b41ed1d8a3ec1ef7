// The twin with a simulated crane: the twin agrees with its own plant, detects and names changes, and
// tolerates bad input.
#include "crane/twin/twin.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <set>

#include "crane/plant/term.hpp"
#include "simulated_motion.hpp"

namespace crane::test {
namespace {

using twin::Judgement;
using twin::Notice;
using twin::State;
using twin::Twin;

const configuration::Rig& rig() {
  static const configuration::Rig kRig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  return kRig;
}

/// Half of the default learning time, which shortens the tests.
twin::Design design() {
  twin::Design quick;
  quick.learn_s = 10;
  return quick;
}

constexpr long kTicksPerSecond = 100;  // ticks

class TwinTest : public testing::Test {
 protected:
  /// @return the first notice within this number of seconds
  std::optional<Notice> watch(double seconds) {
    for (long k = 0; k < std::lround(seconds * kTicksPerSecond); ++k) {
      twin_.step(motion_.next());
      if (auto notice = twin_.take_notice()) return notice;
    }
    return std::nullopt;
  }
  void learn() {
    const auto notice = watch(20);
    ASSERT_FALSE(notice) << notice->what;
    ASSERT_EQ(twin_.judgement().state, State::watching);
  }

  static constexpr std::uint64_t kSeed = 5;
  SimulatedMotion motion_{rig(), kSeed};
  Twin twin_{rig(), design()};
};

TEST(TwinDocument, ShowsTheTableOfTheCauses) {
  std::ifstream in{CRANE_RIGS "/../../docs/twin.md"};
  const std::string text{std::istreambuf_iterator<char>{in}, {}}, before = "<!-- causes of the twin -->\n";
  const auto begin = text.find(before) + before.size();
  EXPECT_EQ(text.substr(begin, text.find("<!-- end -->", begin) - begin), twin::cause_table());
}

TEST(Causes, NameATermOfTheModelAndItsSizeParameter) {
  for (const auto& kind : twin::cause_kinds()) {
    if (kind.parameter == nullptr) continue;
    const auto* term = plant::find_term(kind.name);
    ASSERT_NE(term, nullptr) << kind.name;
    EXPECT_NE(plant::find_parameter(*term, kind.parameter), nullptr) << kind.name << ' ' << kind.parameter;
  }
}

TEST(Causes, WithReferenceSizesHaveHypothesesOnATower) {
  std::set<std::string> hypotheses, with_sizes;
  for (const auto& hypothesis : twin::hypotheses_for(rig())) hypotheses.insert(hypothesis.cause);
  for (const auto& kind : twin::cause_kinds())
    if (!kind.sizes.empty()) with_sizes.insert(kind.name);
  EXPECT_EQ(hypotheses, with_sizes);
}

TEST_F(TwinTest, PredictsItsOwnPlantWithinItsBand) {
  learn();
  int outside = 0;
  for (long k = 0; k < 30 * kTicksPerSecond; ++k) {
    const Judgement& j = twin_.step(motion_.next());
    ASSERT_EQ(j.state, State::watching) << "seed " << kSeed << ", tick " << k;
    for (std::size_t i = 0; i < twin::kColumns; ++i) outside += std::abs(j.residual[i]) > j.band[i];
  }
  EXPECT_LT(outside, 30 * kTicksPerSecond / 1000) << "seed " << kSeed;
  EXPECT_LT(twin_.judgement().evidence, 0.5);
  EXPECT_FALSE(twin_.take_notice());
}

TEST_F(TwinTest, DisturbancesOfTheLearningPhaseRaiseNoAlarm) {
  constexpr std::uint64_t kNoisySeed = 11;
  SimulatedMotion motion{rig(), kNoisySeed, {.drive_v = 0.05, .swing_radps2 = 0.02}};
  Twin twin{rig(), design()};
  for (long k = 0; k < 60 * kTicksPerSecond; ++k) twin.step(motion.next());
  EXPECT_EQ(twin.judgement().state, State::watching)
      << "seed " << kNoisySeed << ": " << twin.judgement().cause;
}

struct Change {
  const char *name, *cause, *axis;
  double size;
  std::function<void(SimulatedMotion&)> happen;
};

void PrintTo(const Change& change, std::ostream* out) { *out << change.name; }

class ChangeTest : public TwinTest, public testing::WithParamInterface<Change> {};

TEST_P(ChangeTest, IsFoundNamedAndMeasured) {
  learn();
  GetParam().happen(motion_);
  const auto notice = watch(40);
  ASSERT_TRUE(notice) << "seed " << kSeed;
  EXPECT_TRUE(notice->deviates);
  const Judgement& j = twin_.judgement();
  EXPECT_EQ(j.state, State::deviates);
  EXPECT_EQ(j.cause, GetParam().cause) << notice->what;
  EXPECT_EQ(j.axis, GetParam().axis) << notice->what;
  // The estimate is linear in the change of the prediction: tolerance one third.
  EXPECT_NEAR(j.size, GetParam().size, std::abs(GetParam().size) / 3) << notice->what;
  EXPECT_NE(notice->what.find(GetParam().cause), std::string::npos) << notice->what;
  EXPECT_FALSE(notice->remedy.empty());
  EXPECT_LE(notice->what.size(), 255U);
  EXPECT_FALSE(watch(3)) << "one event for one deviation";
}

Change term(const char* name, const char* cause, const char* axis, const char* parameter, double value,
            double size) {
  return {name, cause, axis, size, [=](SimulatedMotion& motion) {
            motion.become_with({cause, axis, {{parameter, value}}});
          }};
}

INSTANTIATE_TEST_SUITE_P(
    Of, ChangeTest,
    testing::Values(term("TrolleyCoulombFriction", "coulomb_friction", "trolley", "level_v", 0.1, 0.1),
                    term("SlewCoulombFriction", "coulomb_friction", "slew", "level_v", 0.1, 0.1),
                    term("TrolleyViscousFriction", "viscous_friction", "trolley", "vspm", 1, 1),
                    term("SlewViscousFriction", "viscous_friction", "slew", "vspm", 0.2, 0.2),
                    term("TrolleyGain", "motor_gain", "trolley", "factor", 0.9, -0.1),
                    term("SlewGain", "motor_gain", "slew", "factor", 1.1, 0.1),
                    term("Payload", "payload_mass", "", "delta_kg", 0.5, 0.5),
                    term("CableLength", "cable_length", "", "delta_m", 0.05, 0.05),
                    Change{"TrolleyEncoderSlip", twin::kEncoderSlip, "trolley", 0.002,
                           [](SimulatedMotion& motion) { motion.slip(0, 0.002); }},
                    Change{"SlewEncoderSlip", twin::kEncoderSlip, "slew", -0.003,
                           [](SimulatedMotion& motion) { motion.slip(1, -0.003); }},
                    Change{"SwingEncoderSlip", twin::kEncoderSlip, "radial", 0.01,
                           [](SimulatedMotion& motion) { motion.slip(2, 0.01); }},
                    Change{"Push", twin::kLoadPushed, "radial", 0.2,
                           [](SimulatedMotion& motion) { motion.push(0.2, 0); }}),
    [](const auto& test) { return std::string{test.param.name}; });

TEST_F(TwinTest, FindsASwingZeroThatChangedDuringMissingTicks) {
  learn();
  motion_.become_with({"swing_offset", "tangential", {{"offset_rad", 0.02}}});
  motion_.next();
  const auto notice = watch(30);
  ASSERT_TRUE(notice);
  EXPECT_EQ(twin_.judgement().cause, "swing_offset") << notice->what;
  EXPECT_EQ(twin_.judgement().axis, "tangential") << notice->what;
}

TEST(TwinOfSwingEncodersWithARestAngle, AgreesWithItsPlant) {
  auto shifted = rig();
  shifted.encoders[3].rest_angle_rad = 0.02;
  shifted.encoders[4].rest_angle_rad = -0.03;
  SimulatedMotion motion{shifted, 5};
  Twin twin{shifted, design()};
  for (long k = 0; k < 40 * kTicksPerSecond; ++k) {
    twin.step(motion.next());
    if (const auto notice = twin.take_notice()) FAIL() << notice->what;
  }
  EXPECT_EQ(twin.judgement().state, State::watching);
}

TEST_F(TwinTest, FindsADeviationFromTheStart) {
  motion_.become_with({"payload_mass", "", {{"delta_kg", 1}}});
  const auto notice = watch(40);
  ASSERT_TRUE(notice);
  EXPECT_EQ(twin_.judgement().cause, "payload_mass") << notice->what;
}

TEST_F(TwinTest, AgreesAgainAfterTheEndOfTheCause) {
  learn();
  motion_.become_with({"coulomb_friction", "slew", {{"level_v", 0.2}}});
  ASSERT_TRUE(watch(30));
  motion_.become(rig().plant, rig().terms);
  const auto notice = watch(30);
  ASSERT_TRUE(notice);
  EXPECT_FALSE(notice->deviates);
  EXPECT_EQ(twin_.judgement().cause, "");
  EXPECT_FALSE(watch(20));
}

TEST_F(TwinTest, ReportsUnknownForACauseOutsideTheList) {
  learn();
  motion_.become_with({"torque_ripple", "slew", {{"amplitude_v", 0.5}, {"period", 0.3}}});
  const auto notice = watch(40);
  ASSERT_TRUE(notice);
  EXPECT_EQ(twin_.judgement().cause, "unknown") << notice->what;
}

TEST_F(TwinTest, WaitsAndCountsAfterMissingTicks) {
  learn();
  for (int missing = 0; missing < 5; ++missing) motion_.next();
  const Judgement& j = twin_.step(motion_.next());
  EXPECT_EQ(j.state, State::waiting);
  EXPECT_EQ(j.gaps, 1U);
  EXPECT_FALSE(watch(10));
  EXPECT_EQ(twin_.judgement().state, State::watching);
}

TEST_F(TwinTest, WaitsAndCountsAfterValuesThatAreNotFinite) {
  learn();
  auto sample = motion_.next();
  sample.applied_v[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(twin_.step(sample).state, State::waiting);
  sample = motion_.next();
  sample.rate[2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(twin_.step(sample).gaps, 2U);
  EXPECT_FALSE(watch(10));
  EXPECT_EQ(twin_.judgement().state, State::watching);
}

TEST_F(TwinTest, RestartsWithANewWriter) {
  learn();
  auto sample = motion_.next();
  sample.epoch = 2;
  sample.tick = 0;
  EXPECT_EQ(twin_.step(sample).state, State::waiting);
  EXPECT_EQ(twin_.judgement().gaps, 1U);
}

TEST_F(TwinTest, DoesNotJudgeAnAxisThatABrakeHolds) {
  learn();
  for (long k = 0; k < 10 * kTicksPerSecond; ++k) {
    auto sample = motion_.next();
    sample.held = {true, true, true};
    sample.counts[0] = 200000;  // the brake holds the axis, independent of the command
    sample.counts[1] = 1000;
    const Judgement& j = twin_.step(sample);
    EXPECT_EQ(j.residual[0], 0);
    EXPECT_EQ(j.residual[1], 0);
  }
}

TEST(TwinOfEveryRig, IsQuietWhileTheCraneRests) {
  for (const auto& entry : std::filesystem::directory_iterator{CRANE_RIGS}) {
    const auto any_rig = configuration::load_rig(entry.path());
    Twin twin{any_rig};
    twin::Sample sample;
    sample.epoch = 1;
    for (std::size_t i = 0; i < plant::kAxes; ++i)
      sample.counts[i] = std::llround(any_rig.encoders[i].sign * any_rig.encoders[i].counts_per_unit *
                                      any_rig.start.position[i]);
    for (; sample.tick < 4 * kTicksPerSecond; ++sample.tick) twin.step(sample);
    EXPECT_EQ(twin.judgement().state, State::learning) << entry.path();
    for (std::size_t i = 0; i < twin::kColumns; ++i)
      EXPECT_NEAR(twin.judgement().residual[i], 0, 1e-3) << entry.path() << ", column " << i;
    EXPECT_FALSE(twin.take_notice());
  }
}

}  // namespace
}  // namespace crane::test
