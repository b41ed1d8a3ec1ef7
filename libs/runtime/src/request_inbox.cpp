#include "crane/runtime/request_inbox.hpp"

#include <algorithm>

#include "crane/runtime/node.hpp"

namespace crane::runtime {

RequestInbox::RequestInbox(const Context& context, std::initializer_list<crane_RequestKind> kinds)
    : requests_{context.ports.input(topics::request)},
      replies_{context.ports.output(topics::reply)},
      kinds_{kinds} {}

bool RequestInbox::receive() {
  bool any = false;
  while (const auto request = requests_.take()) {
    if (std::find(kinds_.begin(), kinds_.end(), request->kind) == kinds_.end()) continue;
    any = true;
    waiting_.push_back(*request);
    if (request->apply_tick > 0) reply(*request, request->header, true, "scheduled");
  }
  return any;
}

std::optional<msg::Request> RequestInbox::take_due(std::uint64_t tick) {
  const auto due = std::find_if(waiting_.begin(), waiting_.end(),
                                [tick](const msg::Request& request) { return request.apply_tick <= tick; });
  if (due == waiting_.end()) return std::nullopt;
  const auto request = *due;
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
