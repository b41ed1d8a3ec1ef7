/// Verdicts in words.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "data_of_truth.hpp"
#include "verdict/judgement.hpp"
#include "verdict/losing_encoders.hpp"
#include "verdict/resolution.hpp"

namespace crane::diagnosis {
namespace {

Diagnosis of(Verdict verdict, std::vector<Cause> causes, std::vector<std::string> rivals = {}) {
  Diagnosis diagnosis;
  diagnosis.verdict = verdict;
  diagnosis.causes = std::move(causes);
  diagnosis.ambiguous_with = std::move(rivals);
  return diagnosis;
}

/// @param picked share of resamples that pick it
Cause cause(const std::string& name, const std::string& axis, double picked) {
  return {name, axis, {}, 0, picked};
}
const Cause kFriction = cause("viscous_friction", "slew", 1), kDrag = cause("load_linear_drag", "", 1),
            kDelay = cause("command_delay", "trolley", 0.6);

TEST(Sentence, NamesAllCauses) {
  EXPECT_EQ(said(of(Verdict::named, {kFriction, kDrag})),
            "The simulation lacks viscous_friction (slew) and load_linear_drag.");
  EXPECT_EQ(said(of(Verdict::parameter, {kFriction})),
            "A parameter of the model is off: viscous_friction (slew).");
}

TEST(Sentence, NamesTheCauseInDoubt) {
  EXPECT_EQ(said(of(Verdict::ambiguous, {kDelay}, {"actuator_lag"})),
            "These data cannot tell command_delay (trolley) from actuator_lag.");
  EXPECT_EQ(
      said(of(Verdict::ambiguous, {kDelay, kFriction}, {"actuator_lag", "command_offset"})),
      "The simulation lacks viscous_friction (slew); these data cannot tell command_delay (trolley) from "
      "actuator_lag, command_offset.");
}

TEST(Sentence, OfADoubtGivesTheReasonAndNoCause) {
  Diagnosis diagnosis = of(Verdict::ambiguous, {kDelay}, {"actuator_lag"});
  doubt(diagnosis, "trolley: friction by position");
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_TRUE(diagnosis.ambiguous_with.empty());
  EXPECT_EQ(diagnosis.sentence,
            "Something is wrong that no known cause explains (trolley: friction by position).");
}

/// Data of a drive axis at 100 Hz. Its motor gives 1.7 m/s2 per volt against 1 V and 2.8 V s/m of friction.
class DriveAxis : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    truth::Case request;
    request.rig = "drive_axis";
    request.seconds = 10;
    data_.emplace(request);
    study_.emplace(data_->rig, data_->train, data_->test);
    study_->learn_disturbance();
  }
  static void TearDownTestSuite() { study_.reset(), data_.reset(); }

  static inline std::optional<DataOfTruth> data_;
  static inline std::optional<Study> study_;
};

TEST_F(DriveAxis, StopsFromALowSpeedWithinARow) {
  EXPECT_NEAR(rows_to_stop(study_->base(), plant::kTrolley, 0.01, {}, 0.01), 0.01 / (1.7 * 1.028 * 0.01),
              1e-6);
}

/// Beside viscous friction, which acts at any speed and takes a fifth off the error by itself.
class LawOfLowSpeed : public DriveAxis {
 protected:
  static const Candidate* candidate(const std::string& name) {
    return &*std::ranges::find(study_->candidates(), name, &Candidate::cause);
  }
  /// @param nats by which viscous friction alone makes each of 90 blocks likelier
  static Diagnosis named_with(double decay_speed, double nats) {
    const Effect friction{candidate("viscous_friction"), {1}};
    Hypotheses hypotheses;
    Fitted alone;
    hypotheses.base.deviance.assign(90, 100);
    alone.deviance.assign(90, 100 - nats);
    alone.deviance[7] -= 0.5 * nats;
    hypotheses.base.error[kTrolleyPosition] = 1;
    alone.error[kTrolleyPosition] = 0.8;
    alone.effects = {friction};
    alone.parameters = 1;
    hypotheses.all = {alone};
    Diagnosis diagnosis = of(
        Verdict::named, {cause("stribeck_friction", "trolley", 1), cause("viscous_friction", "trolley", 1)});
    name_what_rows_show(*study_, hypotheses, {{candidate("stribeck_friction"), {0.5, decay_speed}}, friction},
                        diagnosis);
    return diagnosis;
  }
};

TEST_F(LawOfLowSpeed, IsNamedWhereRowsShowIt) {
  const Diagnosis found = named_with(0.1, 1);
  EXPECT_EQ(found.verdict, Verdict::named);
  EXPECT_EQ(found.causes.size(), 2U);
  EXPECT_TRUE(found.remainder.from.empty());
}

TEST_F(LawOfLowSpeed, IsNotNamedWhereTheAxisStopsBetweenTwoRows) {
  const Diagnosis found = named_with(0.005, 1);
  EXPECT_EQ(found.verdict, Verdict::named);
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes[0].name, "viscous_friction");
  EXPECT_EQ(found.attempted.at(0).name, "stribeck_friction");
  EXPECT_EQ(found.remainder.from.at(0),
            "trolley: friction at speeds that the rows are too far apart to show");
}

TEST_F(LawOfLowSpeed, LeavesAnUnknownErrorWhereNothingElseExplainsAnything) {
  const Diagnosis found = named_with(0.005, 0);
  EXPECT_EQ(found.verdict, Verdict::unknown);
  EXPECT_EQ(
      found.sentence,
      "Something is wrong that no known cause explains (trolley: friction at speeds that the rows are too "
      "far apart to show).");
}

/// Beside the verdict on the rest of the model.
class EncoderThatLosesCounts : public DriveAxis {
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
    name_losing({encoder}, *study_, *study_, diagnosis);
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
  EXPECT_EQ(found.sentence.find("An encoder loses counts. Something is wrong"), 0U) << found.sentence;
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
