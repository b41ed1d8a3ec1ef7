/// Judgement of the score: diagnosis against hidden effects.
#include <gtest/gtest.h>

#include "score/judgement.hpp"

namespace crane::diagnosis::score {
namespace {

using Names = std::vector<std::string>;

Judged judged(const Names& found, const Names& hidden) {
  Diagnosis diagnosis;
  diagnosis.verdict = found.empty() ? Verdict::none : Verdict::named;
  for (const std::string& name : found) diagnosis.causes.push_back({name, "", {}, 0, 1});
  std::vector<HiddenEffect> answer;
  for (const std::string& name : hidden) answer.push_back({name, "", true, {}});
  return judge(diagnosis, answer);
}

TEST(Judgement, OfOneCause) {
  EXPECT_EQ(judged({}, {}), Judged::right);
  EXPECT_EQ(judged({"payload_mass"}, {}), Judged::wrong);
  EXPECT_EQ(judged({}, {"payload_mass"}), Judged::missed);
  EXPECT_EQ(judged({"payload_mass"}, {"payload_mass"}), Judged::right);
  EXPECT_EQ(judged({"payload_mass", "motor_gain"}, {"payload_mass"}), Judged::beside);
  EXPECT_EQ(judged({"actuator_lag"}, {"command_delay"}), Judged::group);
  EXPECT_EQ(judged({"actuator_lag", "motor_gain"}, {"command_delay"}), Judged::wrong);
  EXPECT_EQ(judged({"motor_gain"}, {"command_delay"}), Judged::wrong);
}

TEST(Judgement, OfTwoCauses) {
  const Names hidden{"cable_elasticity", "viscous_friction"};
  EXPECT_EQ(judged({"cable_elasticity", "viscous_friction"}, hidden), Judged::right);
  EXPECT_EQ(judged({"cable_length", "viscous_friction"}, hidden), Judged::group);
  EXPECT_EQ(judged({"viscous_friction"}, hidden), Judged::partly);
  EXPECT_EQ(judged({"cable_length"}, hidden), Judged::partly);
  EXPECT_EQ(judged({"motor_gain"}, hidden), Judged::wrong);
}

TEST(Judgement, OfACauseConfoundedWithBothIsGroup) {
  EXPECT_EQ(judged({"jib_tilt"}, {"command_offset", "swing_offset"}), Judged::group);
}

}  // namespace
}  // namespace crane::diagnosis::score
