#include "replay/recorded_writers.hpp"

#include "crane/runtime/ports.hpp"

namespace crane::replay {

template <class T>
void RecordedWriters::open(std::unique_ptr<Outside<T>>& outside, const topics::Topic<T>& topic,
                           const msg::Header& header) {
  if (outside) return;
  auto bus = bus_of_("recorded_" + std::string{topic.description.name}, header.source, header.epoch);
  auto publisher = bus.publisher(topic, runtime::loop_endpoint(runtime::Clock::lockstep));
  outside = std::make_unique<Outside<T>>(Outside<T>{std::move(bus), std::move(publisher)});
}

void RecordedWriters::open_clock_master(const Cdr& first) {
  if (const auto header = header_of(first)) open(clock_master_, topics::state, *header);
}

bool RecordedWriters::publish_state(const Cdr& cdr, std::optional<std::uint32_t> configuration) {
  auto sample = decoded(topics::state, cdr);
  if (!sample) return false;
  if (configuration) sample->configuration = *configuration;
  open(clock_master_, topics::state, sample->header);
  return clock_master_->publisher.publish(*sample);
}

bool RecordedWriters::publish_supervisor(const Cdr& cdr) {
  const auto sample = decoded(topics::supervisor, cdr);
  if (!sample) return false;
  open(supervisor_, topics::supervisor, sample->header);
  return supervisor_->publisher.publish(*sample);
}

bool RecordedWriters::publish_input(const Received& input) {
  if (input.topic->name == topics::request.description.name) {
    const auto request = decoded(topics::request, input.cdr);
    return request && operator_of(request->header, request->client).requests.publish(*request);
  }
  const auto jog = decoded(topics::jog, input.cdr);
  return jog && operator_of(jog->header, jog->client).jogs.publish(*jog);
}

RecordedWriters::Operator& RecordedWriters::operator_of(const msg::Header& header,
                                                        const std::string& client) {
  const auto key = std::to_string(header.source) + ' ' + std::to_string(header.epoch) + ' ' + client;
  const auto found = operators_.find(key);
  if (found != operators_.end()) return found->second;
  auto bus = bus_of_(client, header.source, header.epoch);
  auto jogs = bus.publisher(topics::jog);
  auto requests = bus.publisher(topics::request);
  return operators_.emplace(key, Operator{std::move(bus), std::move(jogs), std::move(requests)})
      .first->second;
}

}  // namespace crane::replay
