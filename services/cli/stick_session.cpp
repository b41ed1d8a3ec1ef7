#include "cli/stick_session.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "cli/move_follower.hpp"
#include "crane/runtime/node.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::cli {

StickSession::StickSession(bus::Bus& bus)
    : bus_{bus},
      jogs_{bus.publisher(topics::jog)},
      statuses_{bus.subscriber(topics::supervisor)},
      states_{bus.subscriber(topics::state)} {}

Answer StickSession::begin(const std::array<bool, 3>& selected, const Patience& patience) {
  accepted_ = false;
  hold_ticks_ = 0;
  await_state(patience.find_s);
  const auto answer = ask(bus_, {.kind = crane_REQUEST_JOG, .selected = selected}, patience);
  id_ = answer.id;
  return answer;
}

/// Waits for a state, because the supervisor treats a sample without a recent tick as late and then requires
/// a release of the stick.
void StickSession::await_state(double patience_s) {
  tick_ = 0;
  const auto arrived = [this] {
    receive_states();
    return tick_ > 0;
  };
  if (!wait_until(bus_, patience_s, arrived)) throw NoAnswer("no state" + where_and_remedy(bus_));
}

void StickSession::receive_states() {
  while (const auto state = states_.take()) {
    tick_ = state->header.tick;
    const std::array now{state->trolley_position_m, state->slew_angle_rad, state->cable_length_m};
    if (begins_) measured_ = {now, now, 0};
    begins_ = false;
    measured_.to = now;
    measured_.largest_swing_rad = std::max(measured_.largest_swing_rad,
                                           std::hypot(state->swing_radial_rad, state->swing_tangential_rad));
  }
}

void StickSession::receive() {
  receive_states();
  while (const auto status = statuses_.take()) {
    if (status->move.request_id != id_) {
      if (accepted_) throw std::runtime_error("jog: " + reason_of_replacement(number_, status->move));
      continue;  // sent before the session was accepted
    }
    accepted_ = true;
    number_ = status->move.number;
    if (status->state != crane_STATE_HOLD && status->state != crane_STATE_RUN) {
      const auto cause = static_cast<supervisor::Cause>(status->cause);
      throw std::runtime_error(std::string{"jog: stopped because of "} + supervisor::name_of(cause) + ": " +
                               supervisor::remedy_for(cause));
    }
    hold_ticks_ = status->state == crane_STATE_HOLD ? hold_ticks_ + 1 : 0;
  }
}

void StickSession::send(const std::optional<Deflection>& stick) {
  msg::Jog sample{};
  sample.header.tick = tick_;
  sample.request_id = id_;
  runtime::assign(sample.client, client_name());
  sample.engaged = stick.has_value();
  for (std::size_t i = 0; stick && i < stick->size(); ++i) sample.deflection[i] = (*stick)[i];
  (void)jogs_.publish(sample);  // a lost sample has the effect of silence
}

bool StickSession::drive(double timeout_s, bool stops,
                         const std::function<std::optional<Deflection>()>& stick,
                         const std::function<bool()>& over) {
  constexpr std::int64_t kEvery_ns = 20'000'000;
  const auto end_ns = runtime::monotonic_ns() + static_cast<std::int64_t>(timeout_s * 1e9);
  for (;;) {
    receive();
    if (over()) return true;
    const auto now_ns = runtime::monotonic_ns();
    if (now_ns >= end_ns || (stops && runtime::stop_requested())) return false;
    if (now_ns >= send_at_ns_) {
      send(stick());
      send_at_ns_ = now_ns + kEvery_ns;
    }
    bus_.wait(std::chrono::nanoseconds{std::min(send_at_ns_, end_ns) - now_ns});
  }
}

void StickSession::release(double timeout_s) {
  const bool rests = drive(
      timeout_s, false, [] { return std::nullopt; }, [this] { return in_hold(); });
  if (!rests)
    throw std::runtime_error("jog: the crane was not at rest before the timeout: look at `crane status`");
}

}  // namespace crane::cli
