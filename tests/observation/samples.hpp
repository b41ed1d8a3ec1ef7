#pragma once
/// Samples in the form in which the bus delivers them.
#include <algorithm>

#include "crane/runtime/node.hpp"
#include "observation/sample.hpp"

namespace crane::observation {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
inline constexpr std::int64_t kLoopPeriod_ns = kSecond_ns / 100;

template <class T>
SamplePtr sample_of(const topics::Topic<T>& topic, T message, std::int64_t at_ns, std::uint64_t tick = 1) {
  message.header.tick = tick;
  message.header.sample_time_ns = at_ns;
  const auto& codec = bus::CdrCodec::of(*topic.description.descriptor);
  auto sample = std::make_shared<Sample>();
  const auto found = std::ranges::find(topics::kAll, topic.description.name, &topics::Description::name);
  sample->topic = static_cast<std::size_t>(found - topics::kAll.begin());
  sample->header = message.header;
  sample->source_time_ns = sample->arrival_time_ns = sample->written_time_ns = sample->log_time_ns = at_ns;
  sample->cdr = {0, 1, 0, 0};
  sample->cdr.resize(4 + codec.max_encoded_bytes());
  sample->cdr.resize(4 + codec.encode(&message, std::span{sample->cdr}.subspan(4)));
  return sample;
}

inline SamplePtr status_at(std::int64_t at_ns, crane_SupervisorState state, crane_Cause cause,
                           std::uint64_t tick = 1) {
  msg::SupervisorStatus status{};
  status.state = state;
  status.cause = cause;
  return sample_of(topics::supervisor, status, at_ns, tick);
}

}  // namespace crane::observation
