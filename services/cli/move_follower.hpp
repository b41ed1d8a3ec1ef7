#pragma once
/// How a tool that asked for a move knows that it is over.
#include "cli/tool_bus.hpp"

namespace crane::cli {

/// Listens from before the request is sent, so that a short move is not missed.
class MoveFollower {
 public:
  explicit MoveFollower(bus::Bus& bus);

  /// Waits until the trajectory planner has executed the move and the supervisor holds the crane again.
  /// @param id  of the accepted request
  /// @param timeout_s  longest wait
  /// @throws std::runtime_error saying which: the crane stopped, another move replaced this one, the planner
  /// never took it up, or the time is up
  void follow(std::uint64_t id, double timeout_s);

 private:
  /// @return the supervisor has held the crane for long enough. @throws std::runtime_error
  bool over(std::uint64_t id);

  bus::Bus& bus_;
  bus::Subscriber<msg::SupervisorStatus> statuses_;
  bus::Subscriber<msg::Reference> references_;
  std::uint64_t number_ = 0;  ///< of the move as the supervisor counts it; 0: not accepted yet
  bool accepted_ = false;     ///< the supervisor says that this is the move
  bool executed_ = false;     ///< so does the planner
  int held_ticks_ = 0;
};

}  // namespace crane::cli
