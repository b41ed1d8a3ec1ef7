#pragma once
/// Moves between the sessions of a stick: steps of inching and returns to the stop point.
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "cli/inching.hpp"
#include "cli/move_follower.hpp"
#include "cli/operator_request.hpp"

namespace crane::cli {

class JogMoves {
 public:
  explicit JogMoves(bus::Bus& bus);

  /// Takes the samples that have arrived.
  void receive();
  /// Newest measured and reference positions (m, rad, m of cable); nothing before the first sample.
  [[nodiscard]] const std::optional<std::array<double, 3>>& measured() const { return measured_; }
  [[nodiscard]] const std::optional<std::array<double, 3>>& reference() const { return reference_; }

  /// True once after the crane has left HOLD and RUN, or another client has moved it: the operator of this
  /// program then no longer knows the way to an earlier position.
  [[nodiscard]] bool take_interruption() { return std::exchange(interrupted_, false); }

  /// Requests a move and waits for its end. When the wait ends before the move, requests a stop, which locks
  /// the crane.
  /// @param what     prefix of all messages
  /// @param stopped  returns the reason for which the crane must stop now; empty: none
  /// @return false when the supervisor refused the move; the function then prints the reason
  /// @throws std::runtime_error with reason and remedy: the wait ended early, the crane stopped, another move
  ///   replaced this one, or the planner did not execute it
  [[nodiscard]] bool execute(const char* what, const AxisTargets& targets, double timeout_s,
                             const std::function<std::string()>& stopped);

 private:
  /// Requests a stop. @throws std::runtime_error always: `why`, and whether the supervisor answered
  [[noreturn]] void stop(const char* what, const std::string& why);

  bus::Bus& bus_;
  MoveFollower follower_;
  bus::Subscriber<msg::SupervisorStatus> statuses_;
  bus::Subscriber<msg::State> states_;
  bus::Subscriber<msg::Reference> references_;
  std::optional<std::array<double, 3>> measured_, reference_;
  bool interrupted_ = false;
};

}  // namespace crane::cli
