#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "crane/bus/seal.hpp"

#include "crane/bus/cdr.hpp"
#include "crane/protection.hpp"
#include "crc32c.hpp"

namespace crane::bus {
namespace {

constexpr std::size_t kCrcBytes = sizeof(std::uint32_t);
using protection::enabled;
using enum protection::Protection;

constexpr std::size_t kVersionBytes = sizeof(std::uint32_t);

/// Encodes a sample. @param dropped  number of bytes at its end that are replaced by the name of the topic
/// and the version of the messages (little endian). @return valid until the next call in this thread; empty
/// when the sample cannot be encoded
std::span<const std::uint8_t> encoded(const topics::Description& topic, const void* sample,
                                      std::size_t dropped, std::size_t name_bytes, std::uint32_t version) {
  const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
  thread_local std::vector<std::uint8_t> buffer;  // reused, to avoid an allocation per sample
  const std::size_t needed = codec.max_encoded_bytes() + topic.name.size() + kVersionBytes;
  if (buffer.size() < needed) buffer.resize(needed);
  const std::size_t bytes = codec.encode(sample, std::span{buffer}.first(codec.max_encoded_bytes()));
  if (bytes < kCrcBytes) return {};
  std::memcpy(buffer.data() + bytes - dropped, topic.name.data(), name_bytes);
  std::size_t end = bytes - dropped + name_bytes;
  for (std::size_t i = 0; i < kVersionBytes; ++i)
    buffer[end++] = static_cast<std::uint8_t>(version >> (8 * i));
  return std::span{buffer}.first(end);
}

/// CRC of all fields before the last one. @return false when the sample cannot be encoded
bool checksum(const topics::Description& topic, const void* sample, std::uint32_t version,
              std::uint32_t& crc) {
  const std::size_t name_bytes = enabled(bus_checksum_of_topic) ? topic.name.size() : 0;
  const auto bytes = encoded(topic, sample, kCrcBytes, name_bytes, version);
  if (bytes.empty()) return false;
  crc = crc32c(bytes);
  return true;
}

}  // namespace

void seal(const topics::Description& topic, void* sample, crane_Source source, std::uint32_t epoch,
          std::uint32_t messages_version) {
  const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
  auto* header = static_cast<msg::Header*>(sample);  // the first member of every topic: is_sealable()
  header->source = source;
  header->epoch = epoch;
  std::uint32_t crc = 0;
  if (!checksum(topic, sample, messages_version, crc))
    return;  // an unterminated string; write() also refuses it
  std::memcpy(static_cast<std::uint8_t*>(sample) + codec.fields().back().offset, &crc, kCrcBytes);
}

std::span<const std::uint8_t> ledger_entry(const topics::Description& topic, const void* sample,
                                           std::uint32_t messages_version) {
  return encoded(topic, sample, 0, topic.name.size(), messages_version);
}

bool intact(const topics::Description& topic, const void* sample, std::uint32_t messages_version) {
  const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
  std::uint32_t carried = 0;
  std::memcpy(&carried, static_cast<const std::uint8_t*>(sample) + codec.fields().back().offset, kCrcBytes);
  std::uint32_t computed = 0;
  return (checksum(topic, sample, messages_version, computed) && computed == carried) ||
         !enabled(bus_checksum);
}

}  // namespace crane::bus
