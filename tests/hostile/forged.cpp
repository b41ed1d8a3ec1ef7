#include "forged.hpp"

#include <algorithm>

namespace crane::hostile {
namespace {

constexpr std::uint8_t kLittle = 1, kQos = 2, kWithData = 4, kWithKey = 8, kFinal = 2;
constexpr std::uint16_t kSentinel = 1, kLease = 0x02, kProtocol = 0x15, kVendor = 0x16, kDomainId = 0x0F,
                        kGuid = 0x50, kBuiltIn = 0x58, kDefaultLocator = 0x31, kMetaLocator = 0x32,
                        kStatusInfo = 0x71;

void put(Bytes& bytes, std::uint64_t value, unsigned count) {
  for (unsigned i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8U * i));
}
template <std::size_t N>
void put(Bytes& bytes, const std::array<std::uint8_t, N>& value) {
  bytes.insert(bytes.end(), value.begin(), value.end());
}
void put_number(Bytes& bytes, std::uint64_t number) {
  put(bytes, number >> 32U, 4);
  put(bytes, number, 4);
}
void parameter(Bytes& bytes, std::uint16_t id, const Bytes& value) {
  put(bytes, id, 2);
  put(bytes, value.size(), 2);
  bytes.insert(bytes.end(), value.begin(), value.end());
}
void sentinel(Bytes& bytes) { put(bytes, kSentinel, 4); }

Bytes guid(const GuidPrefix& prefix) {
  Bytes bytes;
  put(bytes, prefix);
  put(bytes, kParticipant);
  return bytes;
}
/// UDP over IPv4: 127.0.0.1 and a port on which nobody listens.
Bytes locator() {
  constexpr std::uint64_t kUdp4 = 1, kDiscard = 9;
  Bytes bytes;
  put(bytes, kUdp4, 4);
  put(bytes, kDiscard, 4);
  bytes.insert(bytes.end(), 12, 0);
  bytes.insert(bytes.end(), {127, 0, 0, 1});
  return bytes;
}
Bytes number32(std::uint64_t value) {
  Bytes bytes;
  put(bytes, value, 4);
  return bytes;
}
/// Content of DATA up to the sequence number.
Bytes data_head(const Entities& entities, std::uint64_t number) {
  Bytes content;
  put(content, 0, 2);
  put(content, 16, 2);  // octets to the inline QoS
  put(content, entities.reader);
  put(content, entities.writer);
  put_number(content, number);
  return content;
}
constexpr std::array<std::uint8_t, 4> kParameterList{0, 3, 0, 0};  // encapsulation: PL_CDR, little endian

}  // namespace

Bytes header(const GuidPrefix& prefix) {
  Bytes bytes{'R', 'T', 'P', 'S', 2, 1, 1, 0x10};
  put(bytes, prefix);
  return bytes;
}

void append(Bytes& message, std::uint8_t kind, std::uint8_t flags, const Bytes& content) {
  message.push_back(kind);
  message.push_back(flags | kLittle);
  put(message, content.size(), 2);
  message.insert(message.end(), content.begin(), content.end());
}

Entities entities_of(const Bytes& message, const Submessage& data) {
  Entities entities;
  const auto at = message.begin() + static_cast<std::ptrdiff_t>(data.content) + 4;
  std::copy_n(at, 4, entities.reader.begin());
  std::copy_n(at + 4, 4, entities.writer.begin());
  return entities;
}

Bytes alone(const Bytes& message, const Submessage& data) {
  const auto part = [&](std::size_t begin, std::size_t end) {
    return std::span{message}.subspan(begin, end - begin);
  };
  Bytes result;
  for (const auto bytes : {part(0, kHeaderBytes), part(data.at, data.content + data.size)})
    result.insert(result.end(), bytes.begin(), bytes.end());
  constexpr std::size_t kReader = kHeaderBytes + 8;  // after the headers of message and submessage, flags
  std::ranges::copy(kNoEntity, result.begin() + kReader);
  return result;
}

Bytes participant(const GuidPrefix& prefix, std::uint32_t domain) {
  constexpr std::uint64_t kAllEndpoints = 0x0C3F;
  auto content = data_head({kNoEntity, kSpdpWriter}, 1);
  put(content, kParameterList);
  parameter(content, kProtocol, {2, 1, 0, 0});
  parameter(content, kVendor, {1, 0x10, 0, 0});
  parameter(content, kGuid, guid(prefix));
  parameter(content, kDomainId, number32(domain));
  parameter(content, kDefaultLocator, locator());
  parameter(content, kMetaLocator, locator());
  parameter(content, kBuiltIn, number32(kAllEndpoints));
  parameter(content, kLease, {0xFF, 0xFF, 0xFF, 0x7F, 0xFF, 0xFF, 0xFF, 0xFF});
  sentinel(content);
  auto message = header(prefix);
  append(message, kData, kWithData, content);
  return message;
}

Bytes end_of_participant(const GuidPrefix& prefix) {
  auto content = data_head({kNoEntity, kSpdpWriter}, 2);
  parameter(content, kStatusInfo, {0, 0, 0, 3});  // disposed and unregistered
  sentinel(content);
  put(content, kParameterList);
  parameter(content, kGuid, guid(prefix));
  sentinel(content);
  auto message = header(prefix);
  append(message, kData, kQos | kWithKey, content);
  return message;
}

Bytes heartbeat(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t first, std::uint64_t last) {
  static std::uint32_t count = 0x7F000000;  // a later count than that of the writer
  Bytes content;
  put(content, kNoEntity);
  put(content, writer);
  put_number(content, first);
  put_number(content, last);
  put(content, ++count, 4);
  auto message = header(prefix);
  append(message, kHeartbeat, kFinal, content);
  return message;
}
Bytes heartbeat(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t number) {
  return heartbeat(prefix, writer, number, number);
}

Bytes gap(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t first, std::uint64_t next,
          std::uint32_t bits) {
  Bytes content;
  put(content, kNoEntity);
  put(content, writer);
  put_number(content, first);
  put_number(content, next);
  put(content, bits, 4);
  content.insert(content.end(), (bits + 31) / 32 * 4, 0xFF);
  auto message = header(prefix);
  append(message, kGap, 0, content);
  return message;
}

Bytes fragment(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t number,
               const Fragment& fragment) {
  constexpr std::uint8_t kDataFragment = 0x16;
  Bytes content;
  put(content, 0, 2);
  put(content, 28, 2);  // octets to the payload
  put(content, kNoEntity);
  put(content, writer);
  put_number(content, number);
  put(content, fragment.number, 4);
  put(content, fragment.count, 2);
  put(content, fragment.bytes, 2);
  put(content, fragment.sample_bytes, 4);
  content.insert(content.end(), fragment.payload.begin(), fragment.payload.end());
  auto message = header(prefix);
  append(message, kDataFragment, 0, content);
  return message;
}
Bytes fragment(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t number) {
  return fragment(prefix, writer, number, {.sample_bytes = 0x7FFFFFFF});
}

Bytes source(const GuidPrefix& prefix) {
  Bytes content(4);
  const auto own = header(prefix);
  content.insert(content.end(), own.begin() + 4, own.end());  // version, vendor, prefix
  return content;
}

Bytes repeat_all(Bytes entities, std::uint64_t first, std::uint32_t count) {
  constexpr std::uint64_t kSamples = 256;
  put_number(entities, first);
  put(entities, kSamples, 4);
  entities.insert(entities.end(), kSamples / 8, 0xFF);
  put(entities, count, 4);
  return entities;
}

}  // namespace crane::hostile
