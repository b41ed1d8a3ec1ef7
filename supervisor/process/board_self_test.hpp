#pragma once
/// Self-test of the board at the start: several states in a row must show 0 V, all brakes closed and the
/// watchdog relay open. The crane cannot be armed before.
#include "crane/supervisor/state_machine.hpp"
#include "crane/topics.hpp"

namespace crane::supervisor {

class BoardSelfTest {
 public:
  /// @param state  state of this tick; null: none arrived
  SelfTest step(const msg::State* state);

 private:
  SelfTest result_ = SelfTest::not_started;
  int quiet_ = 0, ticks_ = 0;
};

}  // namespace crane::supervisor
