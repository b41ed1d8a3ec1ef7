#pragma once
/// Self-test of the board at the start: ten states in a row must show 0 V, all brakes closed and the watchdog
/// relay open. Until then, the crane cannot be armed.
#include "crane/supervisor/state_machine.hpp"
#include "crane/topics.hpp"
#include "process/ticks.hpp"

namespace crane::supervisor {

class BoardSelfTest {
 public:
  /// The test fails when it has received states for this time without ten safe states in a row.
  static constexpr double kLongest_s = 2;

  /// @param period_s  duration of a tick, > 0
  explicit BoardSelfTest(double period_s) : longest_ticks_{ticks_in(kLongest_s, period_s)} {}

  /// @param state  state of this tick; null: none arrived
  SelfTest step(const msg::State* state);

 private:
  SelfTest result_ = SelfTest::not_started;
  std::uint64_t longest_ticks_;
  std::uint64_t ticks_ = 0;
  int quiet_ = 0;  ///< consecutive safe states
};

}  // namespace crane::supervisor
