#include "stack/operator_client.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "crane/runtime/node.hpp"

namespace crane::stack {

OperatorRequest request_to_follow(const control::Excitation& excitation) {
  OperatorRequest wanted{.kind = crane_REQUEST_FOLLOW};
  wanted.selected[excitation.axis] = true;
  wanted.target[excitation.axis] = excitation.mean_position;
  for (const auto& sine : excitation.sines)
    wanted.sines.push_back({sine.amplitude, sine.frequency_hz, sine.phase_rad});
  wanted.duration_s = excitation.duration_s;
  return wanted;
}

OperatorClient::OperatorClient(bus::Bus& bus, std::string client, std::uint64_t first_id)
    : bus_{bus},
      requests_{bus.publisher(topics::request)},
      replies_{bus.subscriber(topics::reply)},
      client_{std::move(client)},
      next_id_{first_id} {}

std::uint64_t OperatorClient::send(const OperatorRequest& wanted) { return send(wanted, requests_); }

std::uint64_t OperatorClient::send(const OperatorRequest& wanted, bus::Publisher<msg::Request>& writer) {
  msg::Request request{};
  request.header = runtime::answer_to(wanted.newest_status);
  request.id = next_id_++;
  runtime::assign(request.client, client_);
  request.kind = wanted.kind;
  request.apply_tick = wanted.apply_tick;
  std::ranges::copy(wanted.selected, request.selected);
  runtime::assign(request.target, wanted.target);
  std::ranges::copy(wanted.kick_radps, request.kick_radps);
  request.until_tick = wanted.until_tick;
  std::copy_n(wanted.sines.begin(), std::min(wanted.sines.size(), std::size(request.sine)), request.sine);
  request.duration_s = wanted.duration_s;
  request.mode = wanted.mode;
  last_sent_ = request;
  if (!writer.publish(request)) throw bus::Error("the request could not be sent: the middleware refused it");
  return request.id;
}

std::uint64_t OperatorClient::repeat(const OperatorRequest& wanted, std::size_t repetition) {
  const bool keys = bus_.options().credentials.has_value();
  if (keys || repetition % 2 == 0) return send(wanted);
  if (!spare_ || spare_->ids.size() == kUnanswered)
    spare_ = Spare{.requests = bus_.publisher(topics::request)};
  spare_->ids.push_back(send(wanted, spare_->requests));
  return spare_->ids.back();
}

void OperatorClient::prefer_answered_writer(std::uint64_t id) {
  if (!spare_ || !std::ranges::count(spare_->ids, id)) return;
  std::swap(requests_, spare_->requests);
  spare_->ids.clear();
}

void OperatorClient::probe() {
  msg::Request request{};
  request.id = kProbe;
  runtime::assign(request.client, client_);
  request.kind = crane_REQUEST_MOVE;  // without an axis: the supervisor refuses it even if it accepted the id
  (void)requests_.publish(request);
}

void OperatorClient::receive() {
  while (const auto reply = replies_.take())
    if (client_ == reply->client) received_.push_back(*reply);
}

std::optional<msg::Reply> OperatorClient::take_reply(std::uint64_t id, crane_Source source, bool scheduled) {
  const auto found = std::find_if(received_.begin(), received_.end(), [&](const msg::Reply& reply) {
    const bool is_schedule = reply.accepted && std::string_view{reply.reason} == "scheduled";
    return reply.request_id == id && reply.header.source == source && is_schedule == scheduled;
  });
  if (found == received_.end()) return std::nullopt;
  const auto reply = *found;
  received_.erase(found);
  prefer_answered_writer(id);
  return reply;
}

}  // namespace crane::stack
