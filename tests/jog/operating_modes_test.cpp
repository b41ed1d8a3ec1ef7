/// Operating modes in closed loop: what each mode permits and refuses, when a mode may change, and that the
/// reduced speed of maintenance leaves every controller enough speed for a short step.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "crane/supervisor/modes.hpp"
#include "operated_crane.hpp"

namespace crane::jog_test {
namespace {

using testing::HasSubstr;

msg::Request mode_request(crane_OperatingMode mode) {
  msg::Request request{};
  request.kind = crane_REQUEST_MODE;
  request.mode = mode;
  return request;
}

msg::Request trolley_request(crane_RequestKind kind, double target_m = 0) {
  msg::Request request{};
  request.kind = kind;
  request.selected[0] = true;
  request.target[0] = target_m;
  return request;
}

/// Locks the crane, changes the mode and arms the crane again.
void enter(OperatedCrane& crane, crane_OperatingMode mode) {
  ASSERT_EQ(crane.ask(crane_REQUEST_DISARM), "");
  for (int tick = 0; tick < 500 && crane.status().state != crane_STATE_LOCKED; ++tick) crane.run(0.01);
  ASSERT_EQ(crane.ask(mode_request(mode)), "");
  crane.run(1.1);
  ASSERT_EQ(crane.ask(crane_REQUEST_RESET), "");
  crane.run(1.1);
  ASSERT_EQ(crane.ask(crane_REQUEST_ARM), "");
  crane.run_until_hold(2);
  ASSERT_EQ(crane.status().state, crane_STATE_HOLD) << crane.cause();
  ASSERT_EQ(crane.status().mode, mode);
}

struct Permitted {
  crane_OperatingMode mode;
  bool stick, long_move, short_move, excitation;
};

class EveryMode : public testing::TestWithParam<Permitted> {};

TEST_P(EveryMode, PermitsItsRequestsAndNamesItselfInARefusal) {
  OperatedCrane crane{"lqr"};
  const auto& permitted = GetParam();
  enter(crane, permitted.mode);
  const double here_m = crane.state().trolley_position_m;
  const std::string name = supervisor::name_of(static_cast<supervisor::Mode>(permitted.mode));
  const auto expect = [&](const char* what, const msg::Request& request, bool accepted) {
    const auto reason = crane.ask(request);
    if (accepted)
      EXPECT_EQ(reason, "") << what;
    else
      EXPECT_THAT(reason, HasSubstr("mode " + name)) << what;
    crane.run_until_hold(10);
    EXPECT_EQ(crane.status().state, crane_STATE_HOLD) << what << ": " << crane.cause();
  };
  expect("stick", trolley_request(crane_REQUEST_JOG), permitted.stick);
  expect("short move", trolley_request(crane_REQUEST_MOVE, here_m + 0.025), permitted.short_move);
  expect("excitation", trolley_request(crane_REQUEST_FOLLOW, crane.state().trolley_position_m),
         permitted.excitation);
  expect("long move", trolley_request(crane_REQUEST_MOVE, here_m + 0.2), permitted.long_move);
}

INSTANTIATE_TEST_SUITE_P(OperatingModes, EveryMode,
                         testing::Values(Permitted{crane_MODE_SEMI_AUTOMATIC, true, true, true, true},
                                         Permitted{crane_MODE_AUTOMATIC, false, true, true, true},
                                         Permitted{crane_MODE_MANUAL, true, false, false, false},
                                         Permitted{crane_MODE_MAINTENANCE, true, false, true, false}),
                         [](const auto& permitted) {
                           return supervisor::name_of(static_cast<supervisor::Mode>(permitted.param.mode));
                         });

TEST(OperatingModes, ChangeOnlyWhileTheBrakesAreClosed) {
  OperatedCrane crane{"lqr"};
  EXPECT_THAT(crane.ask(mode_request(crane_MODE_MANUAL)), HasSubstr("disarm first"));
  ASSERT_EQ(crane.ask(trolley_request(crane_REQUEST_MOVE, 1.0)), "");
  EXPECT_THAT(crane.ask(mode_request(crane_MODE_MANUAL)), HasSubstr("disarm first"));
  ASSERT_EQ(crane.ask(crane_REQUEST_STOP), "");
  EXPECT_THAT(crane.ask(mode_request(crane_MODE_MANUAL)), HasSubstr("disarm first")) << "during the stop";
  EXPECT_EQ(crane.status().mode, crane_MODE_SEMI_AUTOMATIC);
  crane.run(5);
  ASSERT_EQ(crane.status().state, crane_STATE_LOCKED);
  EXPECT_EQ(crane.ask(mode_request(crane_MODE_MANUAL)), "");
  EXPECT_EQ(crane.status().mode, crane_MODE_MANUAL);
}

TEST(OperatingModes, ChangeMovesNothingAndOpensNoBrake) {
  OperatedCrane crane{"lqr"};
  ASSERT_EQ(crane.ask(crane_REQUEST_DISARM), "");
  crane.run(5);
  crane.every_tick = [&] {
    for (std::size_t i = 0; i < 2; ++i)
      ASSERT_TRUE(crane.state().brake_closed[i] && crane.state().applied_v[i] == 0);
  };
  for (const auto mode : {crane_MODE_MAINTENANCE, crane_MODE_AUTOMATIC, crane_MODE_MANUAL}) {
    ASSERT_EQ(crane.ask(mode_request(mode)), "");
    crane.run(0.5);
    EXPECT_EQ(crane.status().state, crane_STATE_LOCKED);
  }
}

TEST(OperatingModes, LimitTheStickToMicroSpeedInMaintenance) {
  OperatedCrane crane{"time_optimal"};
  enter(crane, crane_MODE_MAINTENANCE);
  ASSERT_EQ(crane.ask(trolley_request(crane_REQUEST_JOG)), "");
  auto jogs = crane.bus().publisher(topics::jog);
  const auto session = crane.last_id();
  double fastest_mps = 0;
  crane.every_tick = [&] {
    msg::Jog sample{};
    sample.header.tick = crane.state().header.tick;
    sample.request_id = session;
    runtime::assign(sample.client, kClient);
    sample.engaged = true;
    sample.deflection[0] = 1;
    ASSERT_TRUE(jogs.publish(sample));
    fastest_mps = std::max(fastest_mps, std::abs(crane.state().trolley_speed_mps));
  };
  crane.run(2);
  EXPECT_EQ(crane.status().state, crane_STATE_RUN) << crane.cause();
  EXPECT_EQ(crane.status().jog_deflection[0], 0.1);
  EXPECT_GT(fastest_mps, 0.01);
  EXPECT_LT(fastest_mps, 0.25) << "reduced speed: a quarter of max_speed = 1 m/s";
}

class EveryLaw : public testing::TestWithParam<std::string> {};

/// The evidence for the largest speed of maintenance.
TEST_P(EveryLaw, TakesAShortStepInMaintenance) {
  OperatedCrane crane{GetParam()};
  enter(crane, crane_MODE_MAINTENANCE);
  double fastest_mps = 0;
  crane.every_tick = [&] { fastest_mps = std::max(fastest_mps, std::abs(crane.state().trolley_speed_mps)); };
  const double target_m = crane.state().trolley_position_m + 0.029;
  ASSERT_EQ(crane.ask(trolley_request(crane_REQUEST_MOVE, target_m)), "");
  crane.run(6);
  EXPECT_THAT(crane.status().state, testing::AnyOf(crane_STATE_HOLD, crane_STATE_RUN)) << crane.cause();
  EXPECT_NEAR(crane.state().trolley_position_m, target_m, 0.01);
  std::cout << GetParam() << ": largest speed " << fastest_mps << " m/s\n";
}

std::vector<std::string> all_laws() {
  std::vector<std::string> names;
  for (const auto& controller : control::controllers()) names.emplace_back(controller.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(OperatingModes, EveryLaw, testing::ValuesIn(all_laws()),
                         [](const auto& law) { return law.param; });

}  // namespace
}  // namespace crane::jog_test
