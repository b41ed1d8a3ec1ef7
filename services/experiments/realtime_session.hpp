#pragma once
/// An operator at a running stack: asks, waits for answers and for states, and keeps what was measured
/// meanwhile.
#include <chrono>
#include <functional>
#include <string>

#include "crane/bus/bus.hpp"
#include "crane/recording/run_table.hpp"
#include "stack/operator_client.hpp"

namespace crane::experiments {

/// A request was refused, or what was waited for did not happen; what() says why.
class SessionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class RealtimeSession {
 public:
  /// @param meanwhile  called about every 20 ms while waiting; throws to give up (a process died, Ctrl-C)
  RealtimeSession(bus::Bus& bus, std::function<void()> meanwhile);

  /// Sends a request and waits for the supervisor's answer. @throws SessionError when refused
  void request(const stack::Wish& wish, const std::string& what);
  /// The same, again and again for some seconds: causes have to be clear for a second before a reset.
  void request_with_patience(const stack::Wish& wish, const std::string& what);
  /// From LOCKED to HOLD: reset, then arm. @throws SessionError
  void arm();
  /// Waits until the supervisor is in `wanted`. @throws SessionError after `patience` or in a stop state
  void wait_for(crane_SupervisorState wanted, std::chrono::milliseconds patience);
  /// Moves and waits until the crane holds again and the load hangs still. @throws SessionError
  void move_to(const std::array<bool, 3>& selected, const std::array<double, 3>& target,
               std::chrono::milliseconds patience);
  /// Lets time pass.
  void wait(std::chrono::nanoseconds duration);

  /// Everything measured since the last call of start_table().
  [[nodiscard]] const recording::RunTable& table() const { return table_; }
  void start_table() { table_ = {}; }
  [[nodiscard]] const std::optional<msg::State>& state() const { return state_; }
  [[nodiscard]] const std::optional<msg::SupervisorStatus>& status() const { return status_; }

 private:
  /// Why the supervisor refuses; empty: accepted. @throws SessionError without an answer
  std::string refusal_of(const stack::Wish& wish, const std::string& what);
  void take(std::chrono::nanoseconds timeout);
  template <class Condition>
  bool until(Condition condition, std::chrono::nanoseconds patience);

  bus::Bus& bus_;
  std::function<void()> meanwhile_;
  stack::OperatorClient operator_;
  bus::Subscriber<msg::State> states_;
  bus::Subscriber<msg::Reference> references_;
  bus::Subscriber<msg::Demand> demands_;
  bus::Subscriber<msg::SupervisorStatus> statuses_;
  recording::RunTable table_;
  std::optional<msg::State> state_;
  std::optional<msg::SupervisorStatus> status_;
  std::int64_t next_meanwhile_ns_ = 0;
};

/// "STOP_C1 because of SWING_LIMIT; what to do".
[[nodiscard]] std::string in_words(const msg::SupervisorStatus& status);

/// A first request id that no other client uses at the same time.
[[nodiscard]] std::uint64_t unique_first_id();

}  // namespace crane::experiments
