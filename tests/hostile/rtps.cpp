#include "rtps.hpp"

#include <algorithm>
#include <cstring>

namespace crane::hostile {
namespace {

constexpr std::uint8_t kLittleEndian = 1, kInlineQos = 2, kHasData = 4;

std::size_t u16(std::span<const std::uint8_t> bytes, std::size_t at, bool little) {
  if (at + 2 > bytes.size()) return 0;
  const unsigned a = bytes[at], b = bytes[at + 1];
  return little ? a | b << 8U : a << 8U | b;
}

/// End of a parameter list. @return nothing when it has none
std::optional<std::size_t> after_parameters(std::span<const std::uint8_t> bytes, std::size_t at,
                                            bool little) {
  constexpr std::size_t kSentinel = 1;
  while (at + 4 <= bytes.size()) {
    const auto id = u16(bytes, at, little), length = u16(bytes, at + 2, little);
    if (id == kSentinel) return at + 4;
    at += 4 + length;
  }
  return std::nullopt;
}

constexpr std::size_t kSequenceNumber = 12;  // in the content of DATA: high, then low half

}  // namespace

bool is_rtps(std::span<const std::uint8_t> message) {
  return message.size() >= kHeaderBytes && std::memcmp(message.data(), "RTPS", 4) == 0;
}

std::vector<Submessage> submessages(std::span<const std::uint8_t> message) {
  std::vector<Submessage> found;
  for (std::size_t at = kHeaderBytes; at + 4 <= message.size();) {
    Submessage submessage{message[at], message[at + 1], at, at + 4, 0};
    const auto length = u16(message, at + 2, (submessage.flags & kLittleEndian) != 0);
    const auto left = message.size() - submessage.content;
    submessage.size = length == 0 ? left : std::min(length, left);  // 0: up to the end of the message
    found.push_back(submessage);
    at = submessage.content + submessage.size;
  }
  return found;
}

GuidPrefix prefix_of(const Bytes& message) {
  GuidPrefix prefix{};
  std::copy_n(message.begin() + 8, prefix.size(), prefix.begin());
  return prefix;
}
void set_prefix(Bytes& message, const GuidPrefix& prefix) {
  std::copy(prefix.begin(), prefix.end(), message.begin() + 8);
}

std::span<std::uint8_t> payload_of(Bytes& message, const Submessage& data) {
  if (data.kind != kData || (data.flags & kHasData) == 0 || data.size < kSequenceNumber + 8) return {};
  const bool little = (data.flags & kLittleEndian) != 0;
  const auto content = std::span{message}.subspan(data.content, data.size);
  auto begin = 4 + u16(content, 2, little);
  if ((data.flags & kInlineQos) != 0) {
    const auto end = after_parameters(content, begin, little);
    if (!end) return {};
    begin = *end;
  }
  return begin <= content.size() ? content.subspan(begin) : std::span<std::uint8_t>{};
}

std::uint64_t sequence_number_of(const Bytes& message, const Submessage& data) {
  std::uint32_t high = 0, low = 0;
  std::memcpy(&high, &message[data.content + kSequenceNumber], 4);
  std::memcpy(&low, &message[data.content + kSequenceNumber + 4], 4);
  return std::uint64_t{high} << 32U | low;
}
void set_sequence_number(Bytes& message, const Submessage& data, std::uint64_t number) {
  const auto high = static_cast<std::uint32_t>(number >> 32U), low = static_cast<std::uint32_t>(number);
  std::memcpy(&message[data.content + kSequenceNumber], &high, 4);
  std::memcpy(&message[data.content + kSequenceNumber + 4], &low, 4);
}

}  // namespace crane::hostile
