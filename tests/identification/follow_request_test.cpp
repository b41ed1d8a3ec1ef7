/// The request to follow a sum of sines, with the whole stack and the limits of the supervisor.
#include <gtest/gtest.h>

#include "crane/experiment/metrics.hpp"
#include "crane/experiment/scenario.hpp"
#include "experiments/experiment_run.hpp"
#include "stack/data_files.hpp"

namespace crane::experiments {
namespace {

constexpr double kMiddle_m = 0.75;

experiment::Scenario following(double amplitude_m, double frequency_hz, double phase_rad = 0) {
  experiment::Scenario scenario;
  scenario.duration_s = 14;
  scenario.start[plant::kTrolley] = kMiddle_m;
  control::Excitation reference{
      .axis = plant::kTrolley, .mean_position = kMiddle_m, .sines = {}, .duration_s = 10};
  reference.sines[1] = {amplitude_m, frequency_hz, phase_rad};
  scenario.excitations.push_back({.at_s = 0.5, .reference = reference});
  return scenario;
}

std::vector<experiment::Sample> run(const experiment::Scenario& scenario) {
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  const auto started = experiment::with_start_of(rig, scenario);
  TickLog log{std::nullopt};
  const auto outcome = run_in_process(started, runtime::chosen_controller("none", rig), scenario, log);
  EXPECT_TRUE(outcome.completed) << outcome.stopped_because;
  return experiment::samples_from(log.table(outcome.hold_tick));
}

std::string refusal_of(const experiment::Scenario& scenario) {
  try {
    (void)run(scenario);
  } catch (const RunError& refused) {
    return refused.what();
  }
  return "accepted";
}

TEST(FollowRequest, MovesTheReferenceAndNothingElse) {
  const auto scenario = following(0.2, 0.25);
  const auto& excitation = scenario.excitations.front();
  double farthest_m = 0;
  for (const auto& sample : run(scenario)) {
    if (sample.time_s < excitation.at_s + 0.02) continue;
    // Published one tick after the request was accepted, for the tick after it.
    const auto expected = excitation.reference.at(sample.time_s - excitation.at_s - 0.01);
    EXPECT_NEAR(sample.reference[plant::kTrolley], expected.position, 1e-9) << sample.time_s;
    EXPECT_NEAR(sample.reference[plant::kSlew], 0, 1e-9);
    EXPECT_NEAR(sample.position[plant::kTrolley], expected.position, 0.05);
    farthest_m = std::max(farthest_m, std::abs(sample.position[plant::kTrolley] - kMiddle_m));
  }
  EXPECT_GT(farthest_m, 0.15);
}

TEST(FollowRequest, IsRefusedBeyondTheTravel) {
  EXPECT_NE(refusal_of(following(0.7, 0.1)).find("must lie in"), std::string::npos);
  EXPECT_NE(refusal_of(following(std::nan(""), 0.1)).find("must lie in"), std::string::npos);
}

TEST(FollowRequest, IsRefusedBeyondTheSpeed) {
  EXPECT_NE(refusal_of(following(0.2, 2)).find("speed"), std::string::npos);
}

TEST(FollowRequest, IsRefusedWhenTheReferenceBeginsFarFromTheAxis) {
  constexpr double kNear_m = 0.12, kFar_m = 0.13;  // limit: V_max^2 / (2 a_max) = 0.125 m, (3.54)
  const auto beginning = [](double distance_m, double amplitude_m) {
    auto scenario = following(amplitude_m, 0.25);
    scenario.start[plant::kTrolley] = kMiddle_m + distance_m;
    return refusal_of(scenario);
  };
  EXPECT_NE(beginning(kFar_m, 0.1).find("move the axis to the start of the reference first"),
            std::string::npos);
  EXPECT_NE(beginning(-kFar_m, 0.1).find("move the axis to the start of the reference first"),
            std::string::npos);
  EXPECT_EQ(beginning(kNear_m, 0.1), "accepted");
  EXPECT_EQ(beginning(kFar_m, 0), "accepted") << "without sines the reference is a step";
}

TEST(FollowRequest, IsRefusedAboveHalfTheTickRateWhereTheReferenceWouldJumpOrNotBeFinite) {
  EXPECT_EQ(refusal_of(following(0.002, 49)), "accepted");
  EXPECT_NE(refusal_of(following(0.002, 51)).find("frequency_hz"), std::string::npos);
  EXPECT_NE(refusal_of(following(1e-309, 2e307)).find("frequency_hz"), std::string::npos);
}

TEST(FollowRequest, IsRefusedWithoutAPhase) {
  EXPECT_NE(refusal_of(following(0.2, 0.2, std::nan(""))).find("phase_rad"), std::string::npos);
}

}  // namespace
}  // namespace crane::experiments
