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

/// CRC of all fields before the last one, followed by the name of the topic and the version of the messages
/// (little endian). @return false when the sample cannot be encoded
bool checksum(const topics::Description& topic, const void* sample, std::uint32_t version,
              std::uint32_t& crc) {
  const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
  thread_local std::vector<std::uint8_t> buffer;  // reused, to avoid an allocation per sample
  const std::size_t needed = codec.max_encoded_bytes() + topic.name.size() + kVersionBytes;
  if (buffer.size() < needed) buffer.resize(needed);
  const std::size_t bytes = codec.encode(sample, std::span{buffer}.first(codec.max_encoded_bytes()));
  if (bytes < kCrcBytes) return false;
  const std::size_t name_bytes = enabled(bus_checksum_of_topic) ? topic.name.size() : 0;
  std::memcpy(buffer.data() + bytes - kCrcBytes, topic.name.data(), name_bytes);
  std::size_t end = bytes - kCrcBytes + name_bytes;
  for (std::size_t i = 0; i < kVersionBytes; ++i)
    buffer[end++] = static_cast<std::uint8_t>(version >> (8 * i));
  crc = crc32c(std::span{buffer}.first(end));
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

bool intact(const topics::Description& topic, const void* sample, std::uint32_t messages_version) {
  const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
  std::uint32_t carried = 0;
  std::memcpy(&carried, static_cast<const std::uint8_t*>(sample) + codec.fields().back().offset, kCrcBytes);
  std::uint32_t computed = 0;
  return (checksum(topic, sample, messages_version, computed) && computed == carried) ||
         !enabled(bus_checksum);
}

}  // namespace crane::bus
