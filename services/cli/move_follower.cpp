#include "cli/move_follower.hpp"

#include <cmath>
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

std::string reason_of_replacement(std::uint64_t number, const msg::AcceptedMove& present) {
  return present.number > number ? "replaced by a later move"
                                 : "the supervisor has restarted, which stops the crane: look at "
                                   "`crane status`, then reset and arm the crane";
}

MoveFollower::MoveFollower(bus::Bus& bus)
    : bus_{bus},
      statuses_{bus.subscriber(topics::supervisor)},
      references_{bus.subscriber(topics::reference)} {}

bool MoveFollower::over(std::uint64_t id) {
  while (const auto reference = references_.take()) {
    if (move_.number > 0 && reference->move_number == move_.number) reference_ = *reference;
  }
  while (const auto status = statuses_.take()) {
    if (status->move.request_id != id) {
      if (accepted_) throw std::runtime_error("move: " + reason_of_replacement(move_.number, status->move));
      continue;  // sent before the move was accepted
    }
    accepted_ = true;
    move_ = status->move;
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
  accepted_ = false;
  reference_.reset();
  move_ = {};
  held_ticks_ = 0;
  bool is_over = false;
  (void)wait_until(bus_, timeout_s, [&] { return (is_over = over(id)) || stopped(); });
  if (!is_over) return false;
  if (!reference_)
    throw std::runtime_error(
        "move: the trajectory planner has not executed the move; the crane has not moved; repeat the "
        "command");
  require_target();
  return true;
}

void MoveFollower::require_target() const {
  constexpr double kTolerance = 1e-3;  // m or rad
  for (std::size_t i = 0; move_.kind == crane_REQUEST_MOVE && i < control::kAxes; ++i)
    if (move_.selected[i] && std::abs(reference_->axis[i].position - move_.target[i]) > kTolerance)
      throw std::runtime_error("move: ended before the target: the reference of the " +
                               std::string{plant::kCoordinates[i].name} + " axis is " +
                               fields::shortest(reference_->axis[i].position) + " instead of " +
                               fields::shortest(move_.target[i]) +
                               "; `crane log` or the events of the trajectory planner state the reason");
}

}  // namespace crane::cli
