#include "mutate.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace crane::hostile {
namespace {

constexpr std::size_t kMostBytes = 60'000;  // of a UDP datagram

std::size_t any_place(const Bytes& message, std::size_t width, Random& random) {
  return message.size() <= kHeaderBytes + width
             ? 0
             : kHeaderBytes + random() % (message.size() - kHeaderBytes - width);
}

void flip_bits(Bytes& message, Random& random) {
  for (auto left = 1 + random() % 8; left > 0; --left)
    message[random() % message.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
}

void put_number(Bytes& message, Random& random) {
  static constexpr std::array<std::uint32_t, 10> kNumbers{
      0, 1, 3, 0x7F, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF, 0x10000};
  const auto number =
      random() % 4 == 0 ? static_cast<std::uint32_t>(random()) : kNumbers[random() % kNumbers.size()];
  const std::size_t width = random() % 2 == 0 ? 4 : 2;
  const auto at = any_place(message, width, random) & ~std::size_t{1};
  if (at + width <= message.size()) std::memcpy(&message[at], &number, width);
}

void change_submessage(Bytes& message, const Bytes& other, Random& random) {
  const auto parts = submessages(message);
  const auto others = submessages(other);
  if (parts.empty() || others.empty()) return;
  const auto& part = parts[random() % parts.size()];
  const auto begin = message.begin() + static_cast<std::ptrdiff_t>(part.at);
  const auto end = message.begin() + static_cast<std::ptrdiff_t>(part.content + part.size);
  const Bytes copy(begin, end);
  const auto& foreign = others[random() % others.size()];
  switch (random() % 5) {
    case 0:
      message.erase(begin, end);
      break;
    case 1:
      for (auto times = 1 + random() % 16; times > 0 && message.size() < kMostBytes; --times)
        message.insert(message.end(), copy.begin(), copy.end());
      break;
    case 2:
      message.insert(message.end(), other.begin() + static_cast<std::ptrdiff_t>(foreign.at),
                     other.begin() + static_cast<std::ptrdiff_t>(foreign.content + foreign.size));
      break;
    case 3:  // kind or flags
      message[part.at + random() % 2] = static_cast<std::uint8_t>(random());
      break;
    default:  // length
      message[part.at + 2 + random() % 2] = static_cast<std::uint8_t>(random());
  }
}

void change_size(Bytes& message, Random& random) {
  if (random() % 2 == 0) {
    message.resize(kHeaderBytes + random() % (message.size() - kHeaderBytes + 1));
    return;
  }
  for (auto left = random() % 512; left > 0; --left) message.push_back(static_cast<std::uint8_t>(random()));
}

}  // namespace

Bytes mutated(Bytes message, const Bytes& other, Random& random) {
  for (auto left = 1 + random() % 4; left > 0 && message.size() > kHeaderBytes; --left) {
    switch (random() % 4) {
      case 0:
        flip_bits(message, random);
        break;
      case 1:
        put_number(message, random);
        break;
      case 2:
        change_submessage(message, other, random);
        break;
      default:
        change_size(message, random);
    }
  }
  if (message.size() > kMostBytes) message.resize(kMostBytes);
  return message;
}

void Corpus::add(const Bytes& message) {
  Bytes kinds;
  for (const auto& part : submessages(message)) kinds.push_back(part.kind);
  auto known =
      std::find_if(counts_.begin(), counts_.end(), [&](const auto& entry) { return entry.first == kinds; });
  if (known == counts_.end()) known = counts_.insert(counts_.end(), {kinds, 0});
  if (++known->second <= kMostPerKind) messages_.push_back(message);
}

}  // namespace crane::hostile
