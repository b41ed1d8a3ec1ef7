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
      references_{bus.subscriber(topics::reference)},
      states_{bus.subscriber(topics::state)} {}

bool MoveFollower::over(std::uint64_t id) {
  while (const auto reference = references_.take()) {
    if (move_.number > 0 && reference->move_number == move_.number) reference_ = *reference;
  }
  while (const auto state = states_.take()) state_ = *state;
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
  constexpr double kSameReference = 1e-3;  // m or rad
  constexpr double kAtTarget = 0.02;       // m or rad: twice the band in which the planner ends a move
  if (move_.kind != crane_REQUEST_MOVE) return;
  const std::array measured{state_ ? state_->trolley_position_m : 0, state_ ? state_->slew_angle_rad : 0,
                            state_ ? state_->cable_length_m : 0};
  for (std::size_t i = 0; i < control::kAxes; ++i) {
    if (!move_.selected[i]) continue;
    const auto& axis = plant::kCoordinates[i];
    const auto place = [&axis](double value) { return fields::shortest(value) + " " + axis.unit; };
    const std::string target = place(move_.target[i]);
    const std::string axis_name = axis.name;
    if (std::abs(reference_->axis[i].position - move_.target[i]) > kSameReference)
      throw TargetNotReached("move: ended before the target: the reference of the " + axis_name +
                             " axis is " + place(reference_->axis[i].position) + " instead of " + target);
    if (state_ && std::abs(measured[i] - move_.target[i]) > kAtTarget)
      throw TargetNotReached("move: the " + axis_name + " axis is at " +
                             place(std::round(1e3 * measured[i]) / 1e3) + " instead of " + target +
                             "; the reason may be friction, wind or the offset of a swing sensor");
  }
}

}  // namespace crane::cli
