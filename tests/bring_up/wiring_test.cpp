// judge() with constructed evidence.
#include "crane/bring_up/wiring.hpp"

#include <gtest/gtest.h>

#include "bench.hpp"

namespace crane::bring_up::test {
namespace {

/// Evidence of a rig without faults.
Evidence good() {
  Evidence evidence;
  for (std::size_t i = 0; i < kDrives; ++i) {
    auto& axis = evidence.axis[i];
    axis.pushed = true;
    axis.moved[i] = 0.03;
    axis.expected_rad = 0.03;
    axis.share = 1;
  }
  return evidence;
}

/// Drive, encoder or swing encoder with wrong sign, for every combination of the observed signs.
TEST(Judgement, ReportsTheSignThatContradictsTheOtherTwo) {
  const auto blamed = [](double moved, double share) {
    auto evidence = good();
    evidence.axis[0].moved[0] = moved;
    evidence.axis[0].share = share;
    const auto findings = judge(tower(), evidence);
    return findings.empty() ? std::string{"nobody"} : std::string{name_of(findings.front().fault)};
  };
  EXPECT_EQ(blamed(0.03, 1), "nobody");
  EXPECT_EQ(blamed(-0.03, 1), "drive_sign");
  EXPECT_EQ(blamed(-0.03, -1), "encoder_sign");
  EXPECT_EQ(blamed(0.03, -1), "swing_sign");
}

TEST(Judgement, ReportsAnUndecidedSignWhenNoLoadShowsTheDirection) {
  auto evidence = good();
  evidence.axis[1].moved[1] = -0.1;
  evidence.axis[1].expected_rad = 0.002;  // the trolley stands at the tower
  const auto findings = judge(tower(), evidence);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].fault, Fault::drive_or_encoder_sign);
}

TEST(Judgement, ReportsAnAmplifierThatDrivesAtZeroVolts) {
  auto evidence = good();
  evidence.axis[2].drift = -0.004;
  const auto findings = judge(tower(), evidence);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].fault, Fault::drift);
}

TEST(Judgement, ReportsSeveralFaultsInTheOrderOfTheChecks) {
  auto evidence = good();
  evidence.axis[2].moved[2] = 0;
  evidence.axis[0].share = -1;
  evidence.axis[1].held = false;
  evidence.axis[1].pushed = false;
  const auto findings = judge(tower(), evidence);
  ASSERT_EQ(findings.size(), 3U);
  EXPECT_EQ(findings[0].fault, Fault::swing_sign);
  EXPECT_EQ(findings[1].fault, Fault::brake_slips);
  EXPECT_EQ(findings[2].fault, Fault::drive_or_encoder_dead);
}

TEST(Judgement, IgnoresDrivesThatTheRigDoesNotHave) {
  auto rig = tower();
  rig.drives[2].present = false;
  auto evidence = good();
  evidence.axis[2] = {};
  EXPECT_TRUE(judge(rig, evidence).empty());
}

TEST(Judgement, HasANameForEveryFault) {
  std::set<std::string_view> names;
  for (int fault = 0; fault <= static_cast<int>(Fault::swing_dead); ++fault)
    names.insert(name_of(static_cast<Fault>(fault)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(Fault::swing_dead) + 1);
}

}  // namespace
}  // namespace crane::bring_up::test
