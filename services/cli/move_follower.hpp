#pragma once
/// Waits for the end of a requested move.
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "cli/tool_bus.hpp"

namespace crane::cli {

/// Reason why a move or a session of the stick that was accepted as `number` is no longer the present one.
/// @param present the present move: a later one, or one of a restarted supervisor, which counts from 1
[[nodiscard]] std::string reason_of_replacement(std::uint64_t number, const msg::AcceptedMove& present);

/// The move has ended, but an axis is away from its target. The crane is in HOLD.
class TargetNotReached : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Must be created before the request is sent, so that a short move is not missed.
class MoveFollower {
 public:
  explicit MoveFollower(bus::Bus& bus);

  /// Waits until the trajectory planner has executed the move and the supervisor is in HOLD again.
  /// @param id         id of the accepted request
  /// @param timeout_s  longest wait
  /// @throws std::runtime_error with the reason: the crane stopped, another move replaced this one, the
  ///   planner did not execute the move, or timeout
  /// @throws TargetNotReached
  void follow(std::uint64_t id, double timeout_s);
  /// Waits like follow(), until `stopped` returns true at the latest.
  /// @return true at the end of the move; false after a stop signal, at the timeout, or when `stopped`
  ///   returned true: the crane may still move
  /// @throws std::runtime_error like follow(), except at the timeout
  [[nodiscard]] bool follow_until(std::uint64_t id, double timeout_s, const std::function<bool()>& stopped);

 private:
  /// @return true when the supervisor has been in HOLD for enough ticks. @throws std::runtime_error
  bool over(std::uint64_t id);

  /// @throws TargetNotReached
  void require_target() const;

  bus::Bus& bus_;
  bus::Subscriber<msg::SupervisorStatus> statuses_;
  bus::Subscriber<msg::Reference> references_;
  bus::Subscriber<msg::State> states_;
  msg::AcceptedMove move_{};                 ///< number 0: not accepted yet
  std::optional<msg::Reference> reference_;  ///< newest one that executes the move
  std::optional<msg::State> state_;          ///< newest
  bool accepted_ = false;                    ///< true: the supervisor has published this move
  int held_ticks_ = 0;
};

}  // namespace crane::cli
