#include "process/board_self_test.hpp"

#include <gtest/gtest.h>

namespace crane::supervisor {
namespace {

msg::State state_of_board(bool relay_open) {
  msg::State state{};
  for (bool& closed : state.brake_closed) closed = true;
  state.watchdog_dropped = relay_open;
  return state;
}

class SelfTestOfTheBoard : public testing::TestWithParam<double> {};

/// The relay may open up to 0.5 s after the start, whatever the period.
TEST_P(SelfTestOfTheBoard, PassesWhenTheRelayOpensWithinTwoSeconds) {
  BoardSelfTest test{GetParam()};
  const auto closed = state_of_board(false), open = state_of_board(true);
  for (double time_s = 0; time_s < 0.5; time_s += GetParam())
    ASSERT_EQ(test.step(&closed), SelfTest::running);
  for (int i = 0; i < 9; ++i) ASSERT_EQ(test.step(&open), SelfTest::running);
  EXPECT_EQ(test.step(&open), SelfTest::passed);
}

TEST_P(SelfTestOfTheBoard, FailsWhenTheRelayStaysClosed) {
  BoardSelfTest test{GetParam()};
  const auto closed = state_of_board(false);
  for (double time_s = 0; time_s < 2.1; time_s += GetParam()) (void)test.step(&closed);
  EXPECT_EQ(test.step(&closed), SelfTest::failed);
}

INSTANTIATE_TEST_SUITE_P(Periods, SelfTestOfTheBoard, testing::Values(0.001, 0.01),
                         [](const auto& test) { return test.param < 0.005 ? "Of1ms" : "Of10ms"; });

}  // namespace
}  // namespace crane::supervisor
