#include "cli/move_follower.hpp"

#include <stdexcept>

#include "crane/supervisor/states.hpp"

namespace crane::cli {
namespace {

// Consecutive ticks in HOLD that end a move; more than one, because single ticks of HOLD occur during a move.
constexpr int kSettledTicks = 50;

[[noreturn]] void throw_stopped(const msg::SupervisorStatus& status) {
  const auto cause = static_cast<supervisor::Cause>(status.cause);
  throw std::runtime_error(
      std::string{"move: stopped in "} + supervisor::name_of(static_cast<supervisor::State>(status.state)) +
      " because of " + supervisor::name_of(cause) + ": " + supervisor::remedy_for(cause));
}

}  // namespace

MoveFollower::MoveFollower(bus::Bus& bus)
    : bus_{bus},
      statuses_{bus.subscriber(topics::supervisor)},
      references_{bus.subscriber(topics::reference)} {}

bool MoveFollower::over(std::uint64_t id) {
  while (const auto reference = references_.take())
    executed_ = executed_ || (number_ > 0 && reference->move_number == number_);
  while (const auto status = statuses_.take()) {
    if (status->move.request_id != id) {
      if (accepted_) throw std::runtime_error("move: replaced by a later move");
      continue;  // sent before the move was accepted
    }
    accepted_ = true;
    number_ = status->move.number;
    if (status->state != crane_STATE_HOLD && status->state != crane_STATE_RUN) throw_stopped(*status);
    held_ticks_ = status->state == crane_STATE_HOLD ? held_ticks_ + 1 : 0;
  }
  return held_ticks_ >= kSettledTicks;
}

void MoveFollower::follow(std::uint64_t id, double timeout_s) {
  if (follow_until(id, timeout_s, [] { return false; })) return;
  throw std::runtime_error(
      runtime::stop_requested()
          ? "move: waiting was interrupted; the crane continues to move"
          : "move: the target was not reached before the timeout; the crane continues to move");
}

bool MoveFollower::follow_until(std::uint64_t id, double timeout_s, const std::function<bool()>& stopped) {
  accepted_ = executed_ = false;
  number_ = 0;
  held_ticks_ = 0;
  bool is_over = false;
  (void)wait_until(bus_, timeout_s, [&] { return (is_over = over(id)) || stopped(); });
  if (!is_over) return false;
  if (!executed_)
    throw std::runtime_error(
        "move: the trajectory planner has not executed the move; the crane has not moved; repeat the "
        "command");
  return true;
}

}  // namespace crane::cli
