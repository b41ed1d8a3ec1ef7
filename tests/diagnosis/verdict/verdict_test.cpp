/// Verdicts as sentences.
#include <gtest/gtest.h>

#include <optional>

#include "laboratory/data_of_truth.hpp"
#include "verdict/judgement.hpp"
#include "verdict/losing_encoders.hpp"
#include "verdict/sentence.hpp"

namespace crane::diagnosis {
namespace {

Diagnosis of(Verdict verdict, std::vector<Cause> causes, std::vector<std::string> rivals = {}) {
  Diagnosis diagnosis;
  diagnosis.verdict = verdict;
  diagnosis.causes = std::move(causes);
  diagnosis.ambiguous_with = std::move(rivals);
  return diagnosis;
}

/// @param picked share of the resamples that select the cause
Cause cause(const std::string& name, const std::string& axis, double picked) {
  return {name, axis, {}, 0, picked};
}
const Cause kFriction = cause("viscous_friction", "slew", 1), kDrag = cause("load_linear_drag", "", 1),
            kDelay = cause("command_delay", "trolley", 0.6);

TEST(Sentence, NamesAllCauses) {
  EXPECT_EQ(sentence_of(of(Verdict::named, {kFriction, kDrag})),
            "The simulation lacks viscous_friction (slew) and load_linear_drag.");
  EXPECT_EQ(sentence_of(of(Verdict::parameter, {kFriction})),
            "A parameter of the rig file has the wrong value: viscous_friction (slew).");
}

TEST(Sentence, NamesTheCauseInDoubt) {
  EXPECT_EQ(sentence_of(of(Verdict::ambiguous, {kDelay}, {"actuator_lag"})),
            "These data do not distinguish command_delay (trolley) from actuator_lag.");
  EXPECT_EQ(sentence_of(of(Verdict::ambiguous, {kDelay, kFriction}, {"actuator_lag", "command_offset"})),
            "The simulation lacks viscous_friction (slew); these data do not distinguish command_delay "
            "(trolley) from "
            "actuator_lag, command_offset.");
}

/// An inaccuracy at its bound may hide a larger one or a cause without a term.
TEST(Sentence, NamesCalibratedValuesAtTheBoundOfTheStatedAccuracy) {
  Diagnosis diagnosis = of(Verdict::none, {});
  diagnosis.calibrated = {{"motor_gain", "slew", {{"factor", "1", 1.013, 1, 0.02}}},
                          {"direction_asymmetry",
                           "trolley",
                           {{"coulomb_v", "V", 0, 0, 0}, {"viscous_vspm", "V s/m", -0.075, 0, 0.075}}},
                          {"cable_length", "", {{"delta_m", "m", 0.02, 0, 0.02}}}};
  EXPECT_EQ(sentence_of(diagnosis),
            "These data show no error of the model beyond the accuracy of the rig file. At the bound of the "
            "stated accuracy: direction_asymmetry (trolley) viscous_vspm, cable_length delta_m. The accuracy "
            "of the rig file may be lower than stated, or the true cause may have no term.");
  diagnosis.calibrated.resize(1);
  EXPECT_EQ(sentence_of(diagnosis),
            "These data show no error of the model beyond the accuracy of the rig file.");
}

TEST(Sentence, OfADoubtGivesTheReasonAndNoCause) {
  Diagnosis diagnosis = of(Verdict::ambiguous, {kDelay}, {"actuator_lag"});
  make_unknown(diagnosis, "trolley: friction by position");
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_TRUE(diagnosis.ambiguous_with.empty());
  EXPECT_EQ(diagnosis.sentence,
            "The model has an error that no known cause explains (trolley: friction by position).");
}

/// An encoder that loses counts is named in addition to the verdict on the rest of the model.
class EncoderThatLosesCounts : public testing::Test {
 protected:
  static Diagnosis named_beside(Diagnosis diagnosis) {
    const LosingEncoder encoder{.axis = kTrolleyPosition,
                                .jumps = 7,
                                .duration_s = 20,
                                .lost = 0.014,
                                .jump = 0.002,
                                .jump_std_dev = 1e-4,
                                .rate = 0.01,
                                .rate_std_dev = 0.003};
    name_losing({encoder}, 12.5, diagnosis);
    return diagnosis;
  }
};

TEST_F(EncoderThatLosesCounts, IsNamedAlone) {
  const Diagnosis found = named_beside(of(Verdict::none, {}));
  EXPECT_EQ(found.verdict, Verdict::named);
  EXPECT_EQ(found.sentence, "The simulation lacks position_drift (trolley).");
  ASSERT_EQ(found.extension.size(), 1U);
  EXPECT_EQ(found.extension[0].parameters.at("jump"), 0.002);
}

TEST_F(EncoderThatLosesCounts, IsNamedBesideAnUnknownError) {
  const Diagnosis found = named_beside(of(Verdict::unknown, {}));
  EXPECT_EQ(found.verdict, Verdict::unknown);
  EXPECT_EQ(found.sentence.find("An encoder loses counts. The model has an error"), 0U) << found.sentence;
  EXPECT_EQ(found.causes.at(0).name, "position_drift");
}

TEST_F(EncoderThatLosesCounts, IsOneCauseTogetherWithItsDrift) {
  Diagnosis before = of(Verdict::named, {cause("position_drift", "trolley", 1), kFriction});
  before.causes[0].parameters = {{"rate", "m/m", 0.02, 0.004}};
  before.extension = {{"position_drift", "trolley", {{"rate", 0.02}}}, {"viscous_friction", "slew", {}}};
  before.ranking.emplace_back().label = "position_drift (trolley)";
  const Diagnosis found = named_beside(before);
  EXPECT_EQ(found.sentence, "The simulation lacks position_drift (trolley) and viscous_friction (slew).");
  ASSERT_EQ(found.extension.size(), 2U);
  EXPECT_DOUBLE_EQ(found.extension[0].parameters.at("rate"), 0.03);
  EXPECT_EQ(found.extension[1].name, "viscous_friction");
  EXPECT_DOUBLE_EQ(found.causes[0].parameters[0].std_dev, 0.005);
  EXPECT_EQ(found.ranking.size(), 1U);
}

}  // namespace
}  // namespace crane::diagnosis
