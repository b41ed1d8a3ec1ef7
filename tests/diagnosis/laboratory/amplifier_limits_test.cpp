/// Limits of an amplifier: replay and diagnosis of data whose generator shares nothing with them.
#include <gtest/gtest.h>

#include <algorithm>

#include "crane/diagnosis/diagnosis.hpp"
#include "laboratory/amplifier_runs.hpp"
#include "laboratory/expect_cause.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kRate_vps = 100, kLimit_v = 2.4;

configuration::Rig with_term(const plant::TermSetting& term) {
  configuration::Rig rig = rig_of_axis();
  rig.terms.push_back(term);
  return rig;
}

double largest_error(const std::vector<Run>& measured, const configuration::Rig& rig) {
  const DriveError error = error_in(measured, rig);
  return *std::ranges::max_element(error.rms);
}

TEST(AmplifierLimits, AreReplayedAsTheLaboratoryHasThem) {
  const std::vector<diagnosis::Run> slow = runs_of_axis({.rate_vps = kRate_vps}, 8),
                                    weak = runs_of_axis({.limit_v = kLimit_v}, 9);
  EXPECT_GT(largest_error(slow, rig_of_axis()), 5e-3);
  EXPECT_LT(largest_error(slow, with_term({"command_rate_limit", "trolley", {{"rate_vps", kRate_vps}}})),
            1e-3);
  EXPECT_GT(largest_error(weak, rig_of_axis()), 5e-3);
  EXPECT_LT(largest_error(weak, with_term({"command_saturation", "trolley", {{"limit_v", kLimit_v}}})), 1e-3);
}

/// Expects that the diagnosis of an axis with this amplifier names one cause.
void expect_cause_of(const strange::Amplifier& amplifier, const std::string& name, double value) {
  Request request;
  request.most_effects = 1;
  const Diagnosis found =
      diagnose(rig_of_axis(), runs_of_axis(amplifier, 11), runs_of_axis(amplifier, 12), request);
  ASSERT_NO_FATAL_FAILURE(expect_cause(found, name, value, 0.05 * value));
  EXPECT_EQ(found.causes[0].axis, "trolley");
  EXPECT_GT(found.held_out.gain, 0.8);
}

TEST(AmplifierLimits, NameARateLimit) {
  expect_cause_of({.rate_vps = kRate_vps}, "command_rate_limit", kRate_vps);
}

/// The limit acts in few windows: its rms effect is smaller than that of the stated inaccuracies.
TEST(AmplifierLimits, NameARateLimitWithASmallMeanEffect) {
  expect_cause_of({.rate_vps = 2 * kRate_vps}, "command_rate_limit", 2 * kRate_vps);
}

TEST(AmplifierLimits, NameASaturation) {
  expect_cause_of({.limit_v = kLimit_v}, "command_saturation", kLimit_v);
}

}  // namespace
}  // namespace crane::diagnosis
