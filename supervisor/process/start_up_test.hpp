#pragma once
/// Before anything may be armed: the board answers with 0 V, every brake closed and the watchdog relay open,
/// for a while without a break.
#include "crane/supervisor/state_machine.hpp"
#include "crane/topics.hpp"

namespace crane::supervisor {

class StartUpTest {
 public:
  /// @param state  of this tick; null: none came
  SelfTest step(const msg::State* state);

 private:
  SelfTest result_ = SelfTest::not_started;
  int quiet_ = 0, ticks_ = 0;
};

}  // namespace crane::supervisor
