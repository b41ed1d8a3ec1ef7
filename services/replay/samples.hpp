#pragma once
/// Samples as plain CDR with their encapsulation header, and as structs.
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "crane/bus/cdr.hpp"
#include "crane/bus/seal.hpp"
#include "crane/topics.hpp"

namespace crane::replay {

using Cdr = std::vector<std::uint8_t>;

/// @return nothing when the bytes are not a valid sample
template <class T>
[[nodiscard]] std::optional<T> decoded(const topics::Topic<T>& topic, std::span<const std::uint8_t> cdr) {
  T sample{};
  const auto& codec = bus::CdrCodec::of(*topic.description.descriptor);
  if (cdr.size() < bus::kEncapsulation_bytes ||
      !codec.decode(cdr.subspan(bus::kEncapsulation_bytes), false, &sample))
    return std::nullopt;
  return sample;
}

/// The header is the first field of every topic. @return nothing when the sample is too short
[[nodiscard]] std::optional<msg::Header> header_of(std::span<const std::uint8_t> cdr);

/// Replaces the start-up number and the checksum. @return the unchanged sample when it is not valid
[[nodiscard]] Cdr with_epoch(const topics::Description& topic, const Cdr& cdr, std::uint32_t epoch);

/// @param sample  C struct of the topic
[[nodiscard]] Cdr encoded(const topics::Description& topic, const void* sample);

/// Encodes the sample with its checksum, as its writer publishes it. @pre the header has source and epoch
template <class T>
[[nodiscard]] Cdr published(const topics::Topic<T>& topic, T sample) {
  bus::seal(topic.description, &sample, sample.header.source, sample.header.epoch);
  return encoded(topic.description, &sample);
}

}  // namespace crane::replay
