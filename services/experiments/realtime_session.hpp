#pragma once
/// Operates a running stack: sends requests, waits for answers and states, and collects the measurements.
#include <chrono>
#include <functional>
#include <string>

#include "crane/bus/bus.hpp"
#include "crane/recording/run_table.hpp"
#include "stack/operator_client.hpp"

namespace crane::experiments {

/// A request was refused, or an expected state was not reached. what() names the reason.
class SessionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class RealtimeSession {
 public:
  /// @param meanwhile  called about every 20 ms while waiting; throws to end the session (a process ended,
  ///   Ctrl-C)
  RealtimeSession(bus::Bus& bus, std::function<void()> meanwhile);

  /// Sends a request and waits for the supervisor's answer. @throws SessionError when refused
  void request(const stack::OperatorRequest& wanted, const std::string& what);
  /// Repeats a refused request for up to 9 s: a reset is refused until one second after the last
  /// cause. After end_at_stops(), each attempt of a reset first waits for LOCKED. @throws
  /// SessionError after the last refusal
  void request_with_patience(const stack::OperatorRequest& wanted, const std::string& what);
  /// Leads the crane from LOCKED to HOLD: reset, then arm. @throws SessionError
  void arm();
  /// Waits until the supervisor is in `wanted`. @throws SessionError after `patience` or in a stop state
  void wait_for(crane_SupervisorState wanted, std::chrono::milliseconds patience);
  /// Moves, waits until the state is HOLD again, then waits at most `patience` until the load is at rest.
  /// @return whether the load is at rest
  /// @throws SessionError when the move is refused or does not end within `patience`
  bool move_to(const std::array<bool, 3>& selected, const std::array<double, 3>& target,
               std::chrono::milliseconds patience);
  /// Waits for the state that is measured at `sample_time_ns` or later. @pre a state has arrived
  /// (arm())
  /// @throws SessionError when no such state has arrived at `sample_time_ns` + `patience`
  void wait_for_sample(std::int64_t sample_time_ns, std::chrono::nanoseconds patience);
  /// Waits at most `patience` until the load hangs at rest. @return whether it does
  bool wait_for_rest(std::chrono::milliseconds patience);
  /// Waits for `duration`. All samples that have arrived until then are taken.
  void wait(std::chrono::nanoseconds duration);
  /// From now on, requests and waits throw SessionError in these cases: the crane is stopping, in
  /// ESTOP or in FAULT; a cause that is not routine (supervisor::is_routine()) has stopped it; any
  /// cause stops it after it was in HOLD (a program must not reset a stop that it has not
  /// requested); after the first HOLD, the supervisor has accepted a move of another client (the
  /// session must not replace this move).
  void end_at_stops() { ends_at_stops_ = true; }
  /// Disarms the crane and waits at most 2 s until it is LOCKED. Afterwards, stops and moves by
  /// other clients do not end the session. @throws SessionError
  void disarm();
  /// @return whether an operator has reset the crane after disarm()
  [[nodiscard]] bool taken_over() const;

  /// All measurements since the last call of start_table().
  [[nodiscard]] const recording::RunTable& table() const { return table_; }
  void start_table() { table_ = {}; }
  [[nodiscard]] const std::optional<msg::State>& state() const { return state_; }
  [[nodiscard]] const std::optional<msg::SupervisorStatus>& status() const { return status_; }

 private:
  /// @return reason of the supervisor's refusal; empty when accepted. @throws SessionError without an answer
  std::string refusal_of(const stack::OperatorRequest& wanted, const std::string& what);
  void take(std::chrono::nanoseconds timeout);
  void note_reset(const msg::SupervisorStatus& status);
  /// @throws SessionError, see end_at_stops()
  void end_if_stopped(const msg::SupervisorStatus& status);
  /// @throws SessionError, see end_at_stops()
  void end_if_replaced(const msg::AcceptedMove& move);
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
  std::uint64_t first_id_ = 0, last_id_ = 0;  ///< of the requests of this session; 0: none sent yet
  std::uint64_t move_number_ = 0;             ///< AcceptedMove.number of the newest status
  bool ends_at_stops_ = false, was_in_hold_ = false;
  bool disarmed_ = false;    ///< disarm() was called
  bool locked_ = false;      ///< the crane was LOCKED after disarm()
  bool taken_over_ = false;  ///< another client has reset or moved the crane after disarm()
};

/// Text of state, cause and remedy: "STOP_C1 because of SWING_LIMIT; remedy".
[[nodiscard]] std::string in_words(const msg::SupervisorStatus& status);

/// First request id that differs from those of other clients.
[[nodiscard]] std::uint64_t unique_first_id();

}  // namespace crane::experiments
