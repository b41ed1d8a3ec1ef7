#include "dashboard/request_desk.hpp"

#include <unistd.h>

#include "crane/runtime/process.hpp"
#include "dashboard/request_text.hpp"
#include "experiments/realtime_session.hpp"

namespace crane::dashboard {
namespace {

constexpr std::int64_t kPatience_ns =
    2'000'000'000;                                ///< longest wait for an answer, as of the `crane` commands
constexpr std::int64_t kRepeat_ns = 100'000'000;  ///< a stop is repeated until it is answered

}  // namespace

RequestDesk::RequestDesk(bus::Bus& bus)
    : client_{bus, "dashboard " + std::to_string(::getpid()), experiments::unique_first_id()} {}

void RequestDesk::send(const stack::Wish& wish, Answered answered) {
  const auto now_ns = runtime::monotonic_ns();
  pending_.push_back(
      {.wish = wish, .answered = std::move(answered), .ids = {}, .sent_ns = now_ns, .repeat_ns = now_ns});
  advance(pending_.back(), now_ns);
}

void RequestDesk::poll(std::int64_t now_ns) {
  client_.receive();
  for (auto& pending : pending_) advance(pending, now_ns);
  // An answered request stays until its time is over: the answers to its repetitions are taken, too.
  std::erase_if(pending_, [&](const Pending& pending) { return now_ns - pending.sent_ns > kPatience_ns; });
}

void RequestDesk::advance(Pending& pending, std::int64_t now_ns) {
  while (const auto reply = take_reply(pending)) {
    if (!pending.done) pending.answered(*reply);
    pending.done = true;
  }
  if (pending.done) return;
  if (now_ns - pending.sent_ns > kPatience_ns) {
    pending.answered(
        {false, client_.listeners() == 0
                    ? "no supervisor is found: start a stack with `crane up`"
                    : "the supervisor did not answer within 2 s: look whether its ticks advance"});
    pending.done = true;
    return;
  }
  const bool due = pending.ids.empty() || (is_stop(pending.wish.kind) && now_ns >= pending.repeat_ns);
  if (!due || (pending.ids.empty() && client_.listeners() == 0)) return;
  pending.ids.push_back(client_.send(pending.wish));
  pending.repeat_ns = now_ns + kRepeat_ns;
}

std::optional<Reply> RequestDesk::take_reply(const Pending& pending) {
  for (const auto id : pending.ids)
    if (const auto reply = client_.take_reply(id, crane_SOURCE_SUPERVISOR))
      return Reply{reply->accepted, reply->reason};
  return std::nullopt;
}

}  // namespace crane::dashboard
