#include "dashboard/request_text.hpp"

#include <gtest/gtest.h>

#include <random>

#include "crane/runtime/request_kinds.hpp"
#include "dashboard/hold.hpp"

namespace crane::dashboard {
namespace {

TEST(RequestText, AMoveNamesTheAxesThatItMoves) {
  const auto wanted = operator_request_of(R"({"kind":"move","trolley_m":1.05,"slew_rad":-0.5})");
  EXPECT_EQ(wanted.kind, crane_REQUEST_MOVE);
  EXPECT_EQ(wanted.selected, (std::array{true, true, false}));
  EXPECT_EQ(wanted.target, (std::array{1.05, -0.5, 0.0}));
}

TEST(RequestText, AHoldIsAMoveWithoutAxes) {
  EXPECT_TRUE(is_hold(operator_request_of(R"({"kind":"hold"})")));
  EXPECT_FALSE(is_hold(operator_request_of(R"({"kind":"move","slew_rad":0})")));
  EXPECT_THROW((void)operator_request_of(R"({"kind":"hold","slew_rad":0})"), BadRequest);
}

/// The slew axis moves at 0.5 rad/s; the anti-swing control moves the trolley a little.
TEST(Hold, EndsTheMoveOfItsAxesAtTheirPointOfRestAndMovesNoOther) {
  msg::State state{};
  state.trolley_position_m = 0.4;
  state.trolley_speed_mps = 0.1;
  state.slew_angle_rad = -1;
  state.slew_speed_radps = -0.5;
  msg::SupervisorStatus status{};
  for (double& limit_v : status.volt_limit_v) limit_v = 10;
  status.move.number = 3;
  status.move.selected[1] = true;
  const auto hold = move_to_rest(state, status, {0.2, 0.25, 0});
  EXPECT_EQ(hold.kind, crane_REQUEST_MOVE);
  EXPECT_EQ(hold.selected, (std::array{false, true, false}));
  EXPECT_DOUBLE_EQ(hold.target[1], -1.5);
}

TEST(Hold, WithoutAMoveHoldsAllAxesOfTheCrane) {
  msg::State state{};
  state.trolley_position_m = 0.4;
  state.trolley_speed_mps = 0.1;
  msg::SupervisorStatus status{};
  status.volt_limit_v[0] = 10;
  const auto hold = move_to_rest(state, status, {});
  EXPECT_EQ(hold.selected, (std::array{true, false, false}));
  EXPECT_DOUBLE_EQ(hold.target[0], 0.4) << "without an acceleration, the position now";
}

TEST(RequestText, HomeAndResetHaveTheirFields) {
  EXPECT_EQ(operator_request_of(R"({"kind":"home","axis":"hoist"})").selected,
            (std::array{false, false, true}));
  EXPECT_EQ(operator_request_of(R"({"kind":"reset"})").selected, (std::array{false, false, false}));
  EXPECT_EQ(operator_request_of(R"({"kind":"reset","confirm_positions":true})").selected,
            (std::array{true, true, true}));
}

TEST(RequestText, ModeIsNamed) {
  const auto wanted = operator_request_of(R"({"kind":"mode","mode":"maintenance"})");
  EXPECT_EQ(wanted.kind, crane_REQUEST_MODE);
  EXPECT_EQ(wanted.mode, crane_MODE_MAINTENANCE);
}

TEST(RequestText, OnlyStopsNeedNoSeat) {
  for (const auto* kind : {"reset", "arm", "disarm", "stop", "estop"}) {
    const auto wanted = operator_request_of(R"({"kind":")" + std::string{kind} + "\"}");
    EXPECT_EQ(runtime::is_urgent_stop(wanted.kind), std::string_view{kind}.ends_with("stop")) << kind;
  }
}

TEST(RequestText, AnInvalidRequestOfAnOperatorIsRefused) {
  for (const auto* text : {"",
                           "[]",
                           "{}",
                           R"({"kind":"advance"})",
                           R"({"kind":"kick"})",
                           R"({"kind":"follow"})",
                           R"({"kind":1})",
                           R"({"kind":"move"})",
                           R"({"kind":"move","trolley_m":"1"})",
                           R"({"kind":"move","trolley_m":1e999})",
                           R"({"kind":"move","trolley":1})",
                           R"({"kind":"move","trolley_m":null})",
                           R"({"kind":"arm","trolley_m":1})",
                           R"({"kind":"home"})",
                           R"({"kind":"home","axis":"jib"})",
                           R"({"kind":"reset","confirm_positions":1})",
                           R"({"kind":"move","trolley_m":[[[1]]]})",
                           R"({"kind":"mode"})",
                           R"({"kind":"mode","mode":1})",
                           R"({"kind":"mode","mode":"fast"})",
                           R"({"kind":"arm","mode":"manual"})",
                           R"({"kind":"stop","kind":"arm"})",
                           R"({"kind":"move","trolley_m":0.9,"trolley_m":0.5})"})
    EXPECT_THROW((void)operator_request_of(text), BadRequest) << text;
}

TEST(RequestText, MutatedRequestsEitherParseOrAreRefused) {
  const std::string seed = R"({"kind":"move","trolley_m":1.05,"slew_rad":-0.5,"hoist_m":1})";
  std::mt19937 random{11};
  std::uniform_int_distribution<std::size_t> where{0, seed.size() - 1};
  std::uniform_int_distribution<int> what{0, 255};
  for (int i = 0; i < 20'000; ++i) {
    auto text = seed;
    for (int n = 0; n <= i % 3; ++n) text[where(random)] = static_cast<char>(what(random));
    try {
      for (const double target : operator_request_of(text).target) EXPECT_TRUE(std::isfinite(target)) << text;
    } catch (const BadRequest&) {
    }
  }
}

}  // namespace
}  // namespace crane::dashboard
