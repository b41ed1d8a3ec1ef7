#include "process/board_self_test.hpp"

namespace crane::supervisor {
namespace {

constexpr int kQuietTicks = 10;     // consecutive safe states that pass the test
constexpr int kLongestTicks = 200;  // number of states after which the test has failed

bool is_quiet(const msg::State& state) {
  for (std::size_t i = 0; i < kAxes; ++i)
    if (state.applied_v[i] != 0 || !state.brake_closed[i]) return false;
  return state.watchdog_dropped;  // without permission the relay must be open
}

}  // namespace

SelfTest BoardSelfTest::step(const msg::State* state) {
  if (result_ != SelfTest::running && result_ != SelfTest::not_started) return result_;
  result_ = SelfTest::running;
  if (state == nullptr) return result_;
  quiet_ = is_quiet(*state) ? quiet_ + 1 : 0;
  if (quiet_ >= kQuietTicks)
    result_ = SelfTest::passed;
  else if (++ticks_ >= kLongestTicks)
    result_ = SelfTest::failed;
  return result_;
}

}  // namespace crane::supervisor
