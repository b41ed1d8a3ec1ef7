#include "dashboard/request_sender.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "crane/runtime/process.hpp"
#include "crane/runtime/request_kinds.hpp"
#include "dashboard/request_text.hpp"
#include "experiments/realtime_session.hpp"

namespace crane::dashboard {
namespace {

constexpr std::int64_t kRepeat_ns = 100'000'000;  // period of the repetition of an unanswered stop

}  // namespace

RequestSender::RequestSender(bus::Bus& bus)
    : client_{bus, "dashboard " + std::to_string(::getpid()), experiments::unique_first_id()} {}

void RequestSender::send(const stack::OperatorRequest& wanted, Answered answered) {
  if (runtime::is_urgent_stop(wanted.kind)) {
    if (auto* same = same_stop(wanted.kind)) return same->answered.push_back(std::move(answered));
  } else if (std::ranges::count_if(pending_, [](const Pending& p) {
               return !p.done && !runtime::is_urgent_stop(p.wanted.kind);
             }) >= static_cast<std::ptrdiff_t>(kMostWaiting)) {
    return answered({false, "too many requests wait for the supervisor: try again"});
  }
  const auto now_ns = runtime::monotonic_ns();
  pending_.push_back({.wanted = wanted, .answered = {}, .ids = {}, .sent_ns = now_ns, .repeat_ns = now_ns});
  pending_.back().answered.push_back(std::move(answered));
  advance(pending_.back(), now_ns);
}

RequestSender::Pending* RequestSender::same_stop(crane_RequestKind kind) {
  const auto found =
      std::ranges::find_if(pending_, [&](const Pending& p) { return !p.done && p.wanted.kind == kind; });
  return found == pending_.end() ? nullptr : &*found;
}

void RequestSender::poll(std::int64_t now_ns) {
  client_.receive();
  for (auto& pending : pending_) advance(pending, now_ns);
  // An answered stop remains in the list while answers to its repetitions may arrive.
  std::erase_if(pending_, [&](const Pending& pending) {
    return (pending.done && pending.ids.empty()) || now_ns - pending.sent_ns > runtime::kRequestLife_ns;
  });
}

void RequestSender::advance(Pending& pending, std::int64_t now_ns) {
  const auto finish = [&pending](const Reply& reply) {
    if (!std::exchange(pending.done, true))
      for (const auto& answered : pending.answered) answered(reply);
  };
  while (const auto reply = take_reply(pending)) finish(*reply);
  if (pending.done) return;
  if (now_ns - pending.sent_ns > runtime::kRequestLife_ns)
    return finish({false, client_.listeners() == 0
                              ? "no supervisor is found: start a stack with `crane up`"
                              : "the supervisor did not answer within 2 s: look whether its ticks advance"});
  const bool due =
      pending.ids.empty() || (runtime::is_urgent_stop(pending.wanted.kind) && now_ns >= pending.repeat_ns);
  if (due && (!pending.ids.empty() || client_.listeners() > 0)) publish(pending, now_ns);
}

/// If the middleware refuses the request, the next poll tries again until kRequestLife_ns is over.
void RequestSender::publish(Pending& pending, std::int64_t now_ns) {
  try {
    pending.ids.push_back(pending.ids.empty() ? client_.send(pending.wanted)
                                              : client_.repeat(pending.wanted, pending.ids.size()));
    pending.repeat_ns = now_ns + kRepeat_ns;
  } catch (const bus::Error&) {
    pending.repeat_ns = now_ns;
  }
}

std::optional<Reply> RequestSender::take_reply(Pending& pending) {
  for (auto id = pending.ids.begin(); id != pending.ids.end(); ++id)
    if (const auto reply = client_.take_reply(*id, crane_SOURCE_SUPERVISOR)) {
      pending.ids.erase(id);
      return Reply{reply->accepted, reply->reason};
    }
  return std::nullopt;
}

}  // namespace crane::dashboard
