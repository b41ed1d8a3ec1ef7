/// What a verdict says in words.
#include <gtest/gtest.h>

#include "verdict/judgement.hpp"

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

TEST(Sentence, SaysWhichOfTwoCausesIsInDoubt) {
  EXPECT_EQ(said(of(Verdict::ambiguous, {kDelay}, {"actuator_lag"})),
            "These data cannot tell command_delay (trolley) from actuator_lag.");
  EXPECT_EQ(
      said(of(Verdict::ambiguous, {kDelay, kFriction}, {"actuator_lag", "command_offset"})),
      "The simulation lacks viscous_friction (slew); these data cannot tell command_delay (trolley) from "
      "actuator_lag, command_offset.");
}

TEST(Sentence, OfADoubtNamesNoCauseAndSaysWhy) {
  Diagnosis diagnosis = of(Verdict::ambiguous, {kDelay}, {"actuator_lag"});
  doubt(diagnosis, "trolley: friction by position");
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_TRUE(diagnosis.ambiguous_with.empty());
  EXPECT_EQ(diagnosis.sentence,
            "Something is wrong that no known cause explains (trolley: friction by position).");
}

}  // namespace
}  // namespace crane::diagnosis
