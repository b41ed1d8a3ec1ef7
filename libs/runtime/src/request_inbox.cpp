#include "crane/runtime/request_inbox.hpp"

#include <algorithm>

#include "crane/runtime/node.hpp"

namespace crane::runtime {
RequestInbox::RequestInbox(const Context& context, std::initializer_list<crane_RequestKind> kinds)
    : schedules_{context.clock != Clock::realtime},
      ticks_{kRequestLife_s, context.rig.period_s},
      requests_{context.ports.input(topics::request)},
      replies_{context.ports.output(topics::reply)},
      kinds_{kinds} {}

bool RequestInbox::receive() {
  constexpr int kMostPerCall = 64;
  bool any = false;
  bus::SampleInfo info;
  for (int taken = 0; taken < kMostPerCall; ++taken) {
    auto request = requests_.take(&info);
    if (!request) break;
    if (!info.valid || !topics::may_write(topics::request.description, request->header.source)) continue;
    if (std::find(kinds_.begin(), kinds_.end(), request->kind) == kinds_.end()) continue;
    any = true;
    if (!schedules_ && stops_crane(request->kind)) request->apply_tick = 0;
    if (!schedules_ && request->apply_tick > 0) {
      reply(*request, request->header, false,
            "in real time a request acts at once: apply_tick must be 0 (lockstep permits a later tick)");
      continue;
    }
    const bool full = waiting_.size() >= kMostWaiting;
    const bool stops_now =
        stops_crane(request->kind) && request->apply_tick == 0;  // accepted also during a flood
    if (full && !(stops_now && waiting_.size() < kMostWaiting + kMostStops)) {
      reply(*request, request->header, false, "too many requests wait for their tick: send fewer at a time");
      continue;
    }
    waiting_.push_back({*request, info.participant});
    if (request->apply_tick > 0) reply(*request, request->header, true, "scheduled");
  }
  return any;
}

/// A lost connection delays a request until the middleware can send it again, at most for the lease. Another
/// program on the network can record a request, encrypted or not, and send it again in a later run.
std::string_view RequestInbox::obsolete_because(const msg::Request& request, std::int64_t now_ns) const {
  if (schedules_ || stops_crane(request.kind)) return "";
  const auto named_ns = ticks_.time_of(request.header);
  if (!named_ns || now_ns - *named_ns > kRequestLife_ns)
    return "the request names no tick of the last 2 s (header.tick, header.sample_time_ns): repeat the "
           "request";
  if (*named_ns < stopped_ns_)
    return "the crane has stopped after the tick that the request names: look at the crane and repeat the "
           "request";
  return "";
}

void RequestInbox::refuse_untimely(std::uint64_t tick, std::int64_t now_ns) {
  std::erase_if(waiting_, [&](const Waiting& waiting) {
    const auto& request = waiting.request;
    if (const auto reason = obsolete_because(request, now_ns); !reason.empty()) {
      reply(request, request.header, false, reason);
      return true;
    }
    const bool too_late = request.apply_tick > tick && request.apply_tick - tick > kFarthest_ticks;
    if (too_late) reply(request, request.header, false, "apply_tick is more than 1000000 ticks ahead");
    return too_late;
  });
}

std::optional<msg::Request> RequestInbox::take_due(std::uint64_t tick, std::int64_t now_ns,
                                                   bus::ParticipantId* sender) {
  refuse_untimely(tick, now_ns);
  const auto due = std::find_if(waiting_.begin(), waiting_.end(),
                                [tick](const Waiting& w) { return w.request.apply_tick <= tick; });
  if (due == waiting_.end()) return std::nullopt;
  const auto request = due->request;
  if (sender != nullptr) *sender = due->sender;
  waiting_.erase(due);
  return request;
}

void RequestInbox::reply(const msg::Request& request, const msg::Header& header, bool accepted,
                         std::string_view reason) {
  msg::Reply reply{};
  reply.header = header;
  reply.request_id = request.id;
  assign(reply.client, request.client);
  reply.accepted = accepted;
  assign(reply.reason, reason);
  replies_.publish(reply);
}

}  // namespace crane::runtime
