#include "process/board_self_test.hpp"

namespace crane::supervisor {
namespace {

constexpr int kQuietTicks = 10;  // consecutive safe states that pass the test

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
  else if (++ticks_ >= longest_ticks_)
    result_ = SelfTest::failed;
  return result_;
}

}  // namespace crane::supervisor
