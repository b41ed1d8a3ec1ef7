#include "experiments/realtime_session.hpp"

#include <unistd.h>

#include <cmath>
#include <utility>

#include "crane/runtime/process.hpp"
#include "crane/runtime/request_kinds.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::experiments {

std::string in_words(const msg::SupervisorStatus& status) {
  const auto cause = static_cast<supervisor::Cause>(status.cause);
  return std::string{supervisor::name_of(static_cast<supervisor::State>(status.state))} + " because of " +
         supervisor::name_of(cause) + "; " + supervisor::remedy_for(cause);
}

namespace {

bool is_reset(const msg::SupervisorStatus& status) {
  return status.state >= crane_STATE_READY && status.state <= crane_STATE_RUN;
}

}  // namespace

std::uint64_t unique_first_id() {
  return (static_cast<std::uint64_t>(runtime::monotonic_ns()) << 16U) +
         (static_cast<std::uint64_t>(::getpid()) & 0xFFFFU);
}

RealtimeSession::RealtimeSession(bus::Bus& bus, std::function<void()> meanwhile)
    : bus_{bus},
      meanwhile_{std::move(meanwhile)},
      operator_{bus, "session", unique_first_id()},
      states_{bus.subscriber(topics::state)},
      references_{bus.subscriber(topics::reference)},
      demands_{bus.subscriber(topics::demand)},
      statuses_{bus.subscriber(topics::supervisor)} {
  // Recorders also read crane/request: only an answer proves that the supervisor receives the requests.
  constexpr std::int64_t kProbeEvery_ns = 50'000'000;
  std::int64_t probe_at_ns = 0;
  const auto is_answered = [&] {
    if (operator_.listeners() < 2 || operator_.answerers() < 1 || !status_) return false;
    if (operator_.take_reply(stack::OperatorClient::kProbe, crane_SOURCE_SUPERVISOR)) return true;
    if (const auto now_ns = runtime::monotonic_ns(); now_ns >= probe_at_ns) {
      operator_.probe();
      probe_at_ns = now_ns + kProbeEvery_ns;
    }
    return false;
  };
  const bool found = until(is_answered, std::chrono::seconds{5});
  if (!found) throw SessionError("no supervisor found in this domain");
}

void RealtimeSession::take(std::chrono::nanoseconds timeout) {
  bus_.wait(timeout);
  while (const auto sample = states_.take()) table_.add(*(state_ = sample));
  while (const auto sample = references_.take()) table_.add(*sample);
  while (const auto sample = demands_.take()) table_.add(*sample);
  while (const auto sample = statuses_.take()) {
    table_.add(*(status_ = sample));
    note_reset(*sample);
    end_if_stopped(*sample);
    end_if_replaced(sample->move);
  }
  operator_.receive();
  if (runtime::monotonic_ns() < next_meanwhile_ns_) return;
  next_meanwhile_ns_ = runtime::monotonic_ns() + 20'000'000;
  meanwhile_();
}

void RealtimeSession::note_reset(const msg::SupervisorStatus& status) {
  if (!disarmed_) return;
  const bool moves = status.move.number != move_number_;
  taken_over_ = taken_over_ || moves || (locked_ && is_reset(status));
  locked_ = locked_ || status.state == crane_STATE_LOCKED;
}

/// After a long suspension of this program, the samples of LOCKED may be lost.
bool RealtimeSession::taken_over() const { return taken_over_ || (disarmed_ && is_reset(*status_)); }

void RealtimeSession::end_if_stopped(const msg::SupervisorStatus& status) {
  if (!ends_at_stops_) return;
  const auto cause = static_cast<supervisor::Cause>(status.cause);
  const bool routine = cause == supervisor::Cause::none || supervisor::is_routine(cause);
  const bool stopping = status.state >= crane_STATE_STOP_C1;  // STOP_C1, STOP_C0, ESTOP, FAULT
  const bool armed = status.state == crane_STATE_HOLD || status.state == crane_STATE_RUN;
  was_in_hold_ = was_in_hold_ || armed;
  if (stopping || !routine || (was_in_hold_ && !armed))
    throw SessionError("the crane was stopped: " + in_words(status));
}

/// Each accepted move has a new number. A stop has ended the session before, therefore the crane is armed
/// here.
void RealtimeSession::end_if_replaced(const msg::AcceptedMove& move) {
  const bool begins = move.number != std::exchange(move_number_, move.number);
  const bool own = first_id_ > 0 && move.request_id >= first_id_ && move.request_id <= last_id_;
  if (!ends_at_stops_ || !was_in_hold_ || !begins || own) return;
  throw SessionError(std::string{"replaced by a later move of another operator ("} + move.client +
                     "): this program sends no further move");
}

void RealtimeSession::disarm() {
  ends_at_stops_ = false;
  request({.kind = crane_REQUEST_DISARM}, "disarm");
  disarmed_ = true;
  until([this] { return locked_; }, std::chrono::seconds{2});
}

template <class Condition>
bool RealtimeSession::until(Condition condition, std::chrono::nanoseconds patience) {
  const auto deadline_ns = runtime::monotonic_ns() + patience.count();
  while (!condition()) {
    const auto left_ns = deadline_ns - runtime::monotonic_ns();
    if (left_ns <= 0) {
      // After a suspension of this program, the middleware still delivers the samples that arrived meanwhile.
      take(std::chrono::milliseconds{20});
      return condition();
    }
    take(std::chrono::nanoseconds{std::min<std::int64_t>(left_ns, 20'000'000)});
  }
  return true;
}

void RealtimeSession::wait(std::chrono::nanoseconds duration) {
  until([] { return false; }, duration);
}

std::string RealtimeSession::refusal_of(const stack::OperatorRequest& wanted, const std::string& what) {
  take(std::chrono::nanoseconds{0});
  auto dated = wanted;
  if (status_) dated.newest_status = status_->header;
  const auto id = operator_.send(dated);
  if (first_id_ == 0) first_id_ = id;
  last_id_ = id;
  std::optional<msg::Reply> reply;
  if (!until([&] { return (reply = operator_.take_reply(id, crane_SOURCE_SUPERVISOR)).has_value(); },
             std::chrono::nanoseconds{runtime::kRequestLife_ns}))
    throw SessionError(what + ": the supervisor does not answer");
  return reply->accepted ? "" : reply->reason;
}

void RealtimeSession::request(const stack::OperatorRequest& wanted, const std::string& what) {
  if (const auto refusal = refusal_of(wanted, what); !refusal.empty())
    throw SessionError(what + " refused: " + refusal);
}

/// A reset needs causes that have been inactive for a second. Each lost tick on a loaded computer restarts
/// this second.
void RealtimeSession::request_with_patience(const stack::OperatorRequest& wanted, const std::string& what) {
  constexpr int kTries = 30;
  // The supervisor also accepts a reset in ESTOP. take() ends the session there, and after a stop whose cause
  // is not a routine one.
  const bool needs_locked = ends_at_stops_ && wanted.kind == crane_REQUEST_RESET;
  std::string refusal;
  for (int i = 0; i < kTries; ++i) {
    if (needs_locked) wait_for(crane_STATE_LOCKED, std::chrono::seconds{5});
    refusal = refusal_of(wanted, what);
    if (refusal.empty()) return;
    wait(std::chrono::milliseconds{300});
  }
  throw SessionError(what + " refused: " + refusal);
}

void RealtimeSession::wait_for(crane_SupervisorState wanted, std::chrono::milliseconds patience) {
  // Takes the samples that have arrived, because an outdated status of a past stop must not end the wait.
  take(std::chrono::nanoseconds{0});
  const bool reached =
      until([&] { return status_ && (status_->state == wanted || status_->state >= crane_STATE_STOP_C1); },
            patience);
  if (reached && status_->state == wanted) return;
  throw SessionError(std::string{"waiting for "} +
                     supervisor::name_of(static_cast<supervisor::State>(wanted)) + ": the supervisor is in " +
                     in_words(*status_));
}

void RealtimeSession::arm() {
  wait_for(crane_STATE_LOCKED, std::chrono::seconds{5});
  request_with_patience({.kind = crane_REQUEST_RESET}, "reset");
  wait_for(crane_STATE_READY, std::chrono::seconds{3});
  request_with_patience({.kind = crane_REQUEST_ARM}, "arm");
  wait_for(crane_STATE_HOLD, std::chrono::seconds{5});
}

bool RealtimeSession::move_to(const std::array<bool, 3>& selected, const std::array<double, 3>& target,
                              std::chrono::milliseconds patience) {
  request({.kind = crane_REQUEST_MOVE, .selected = selected, .target = target}, "move");
  wait_for(crane_STATE_RUN, std::chrono::seconds{1});
  wait_for(crane_STATE_HOLD, patience);
  return wait_for_rest(patience);
}

void RealtimeSession::wait_for_sample(std::int64_t sample_time_ns, std::chrono::nanoseconds patience) {
  const std::chrono::nanoseconds left{sample_time_ns - state_->header.sample_time_ns};
  const auto measured = [&] { return state_->header.sample_time_ns >= sample_time_ns; };
  if (!measured() && !until(measured, left + patience))
    throw SessionError(
        "states of the plant are missing at the end of the wait: this program was suspended, or the computer "
        "was too busy; repeat the run");
}

bool RealtimeSession::wait_for_rest(std::chrono::milliseconds patience) {
  constexpr double kStill_rad = 0.2 * M_PI / 180;
  constexpr double kStill_radps = 0.01;
  return until(
      [&] {
        return std::abs(state_->swing_radial_rad) < kStill_rad &&
               std::abs(state_->swing_tangential_rad) < kStill_rad &&
               std::abs(state_->swing_radial_radps) < kStill_radps &&
               std::abs(state_->swing_tangential_radps) < kStill_radps;
      },
      patience);
}

}  // namespace crane::experiments
