#pragma once
/// RTPS messages at byte level, without a DDS implementation.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "crane/bus/cdr.hpp"
#include "crane/bus/seal.hpp"
#include "crane/topics.hpp"

namespace crane::hostile {

using Bytes = std::vector<std::uint8_t>;
using GuidPrefix = std::array<std::uint8_t, 12>;

inline constexpr std::size_t kHeaderBytes = 20;  ///< "RTPS", version, vendor, GUID prefix
enum Kind : std::uint8_t { kHeartbeat = 0x07, kGap = 0x08, kAckNack = 0x06, kInfoTime = 0x09, kData = 0x15 };

struct Submessage {
  std::uint8_t kind = 0, flags = 0;
  std::size_t at = 0;       ///< of its own header of 4 bytes
  std::size_t content = 0;  ///< at + 4
  std::size_t size = 0;     ///< of the content
};

[[nodiscard]] bool is_rtps(std::span<const std::uint8_t> message);
[[nodiscard]] std::vector<Submessage> submessages(std::span<const std::uint8_t> message);
[[nodiscard]] GuidPrefix prefix_of(const Bytes& message);
void set_prefix(Bytes& message, const GuidPrefix& prefix);

/// The plain payload of a DATA submessage, encapsulation header included. @return empty when there is none
[[nodiscard]] std::span<std::uint8_t> payload_of(Bytes& message, const Submessage& data);
[[nodiscard]] std::uint64_t sequence_number_of(const Bytes& message, const Submessage& data);
void set_sequence_number(Bytes& message, const Submessage& data, std::uint64_t number);

/// A sample of one topic in a message, and its position.
template <class T>
struct Found {
  Submessage data;
  T sample;
};
/// The intact sample of `topic` in an unencrypted message.
template <class T>
[[nodiscard]] std::optional<Found<T>> find(Bytes& message, const topics::Topic<T>& topic) {
  constexpr std::size_t kEncapsulationBytes = 4;
  for (const auto& submessage : submessages(message)) {
    const auto payload = payload_of(message, submessage);
    if (payload.size() <= kEncapsulationBytes) continue;
    Found<T> found{submessage, {}};
    const auto body = payload.subspan(kEncapsulationBytes);
    if (bus::CdrCodec::of(*topic.description.descriptor).decode(body, false, &found.sample) &&
        bus::intact(topic.description, &found.sample))
      return found;
  }
  return std::nullopt;
}
/// Replaces a sample of the same topic by `sample`, with a correct CRC and the header of `sample`.
template <class T>
void replace(Bytes& message, const Submessage& data, const topics::Topic<T>& topic, T sample) {
  bus::seal(topic.description, &sample, sample.header.source, sample.header.epoch);
  (void)bus::CdrCodec::of(*topic.description.descriptor)
      .encode(&sample, payload_of(message, data).subspan(4));
}

}  // namespace crane::hostile
