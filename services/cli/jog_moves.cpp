#include "cli/jog_moves.hpp"

#include "crane/bus/newest.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::cli {

JogMoves::JogMoves(bus::Bus& bus)
    : bus_{bus},
      follower_{bus},
      statuses_{bus.subscriber(topics::supervisor)},
      states_{bus.subscriber(topics::state)},
      references_{bus.subscriber(topics::reference)} {}

void JogMoves::receive() {
  while (const auto status = statuses_.take()) {
    const bool armed = status->state == crane_STATE_HOLD || status->state == crane_STATE_RUN;
    interrupted_ = interrupted_ || !armed || status->move.client != client_name();
  }
  std::optional<msg::State> state;
  if (bus::take_newest(states_, state)) measured_ = runtime::positions(*state);
  std::optional<msg::Reference> sample;
  if (bus::take_newest(references_, sample))
    reference_ = {sample->axis[0].position, sample->axis[1].position, sample->axis[2].position};
}

bool JogMoves::execute(const char* what, const AxisTargets& targets, double timeout_s,
                       const std::function<std::string()>& stopped) {
  std::optional<Answer> answer;
  try {
    answer = ask(bus_, {.kind = crane_REQUEST_MOVE, .selected = targets.selected, .target = targets.target});
  } catch (const NoAnswer& error) {  // the supervisor may have accepted the move
    stop(what, error.what());
  }
  if (!answer->accepted) {
    report(what, *answer);
    return false;
  }
  std::string why;
  const auto ended = [&] {
    why = stopped();
    return !why.empty();
  };
  try {
    if (follower_.follow_until(answer->id, timeout_s, ended)) return true;
  } catch (const TargetNotReached& error) {  // the operator sees the position and decides
    std::cerr << what << ": " << error.what() << '\n';
    return true;
  }
  if (why.empty())
    why = runtime::stop_requested() ? "interrupted" : "the target was not reached before the timeout";
  stop(what, why);
}

void JogMoves::stop(const char* what, const std::string& why) {
  const std::string prefix = std::string{what} + ": " + why;
  if (stop_crane(bus_))
    throw std::runtime_error(prefix + "; the crane stops and locks: `crane reset`, then `crane arm`");
  throw std::runtime_error(prefix +
                           "; the supervisor has not answered the request to stop: press the emergency stop");
}

}  // namespace crane::cli
