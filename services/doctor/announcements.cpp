#include "doctor/announcements.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "crane/bus/ports.hpp"
#include "crane/runtime/process.hpp"
#include "doctor/interfaces.hpp"

namespace crane::doctor {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t kDomains = 101;  // 0..100, as --domain permits

/// Reader of numbers in the byte order of the sender, little or big endian.
class Reader {
 public:
  Reader(Bytes bytes, bool little) : bytes_{bytes}, little_{little} {}
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  std::uint32_t number(std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value |= std::uint32_t{bytes_[i]} << (8 * (little_ ? i : size - 1 - i));
    skip(size);
    return value;
  }
  void skip(std::size_t size) { bytes_ = bytes_.subspan(size); }
  [[nodiscard]] Bytes rest() const { return bytes_; }

 private:
  Bytes bytes_;
  bool little_;
};

/// @return PID_USER_DATA of a parameter list; empty: none before the end or the first damaged parameter
Bytes user_data_in(Reader list) {
  constexpr std::uint32_t kSentinel = 1, kUserData = 0x2C;
  while (list.left() >= 4) {
    const auto kind = list.number(2), size = list.number(2);
    if (kind == kSentinel || size > list.left()) return {};
    if (kind == kUserData && size >= 4) {
      const auto length = list.number(4);
      return length <= size - 4 ? list.rest().first(length) : Bytes{};
    }
    list.skip(size);
  }
  return {};
}

/// @return the bytes after a parameter list; empty when the list has no end
Bytes after(Reader list) {
  constexpr std::uint32_t kSentinel = 1;
  while (list.left() >= 4) {
    const auto kind = list.number(2), size = list.number(2);
    if (kind == kSentinel) return list.rest();
    if (size > list.left()) break;
    list.skip(size);
  }
  return {};
}

/// User data in the serialised payload of a DATA submessage (9.4.5.4). Cyclone DDS puts a key hash before the
/// payload, as inline QoS.
std::optional<bus::Announcement> announcement_of(Bytes content, std::uint8_t flags) {
  constexpr std::size_t kFixed = 20, kEncapsulation = 4;  // flags, entities, sequence number
  constexpr std::uint8_t kLittleEndian = 0x01, kInlineQos = 0x02, kData = 0x04;
  if ((flags & kData) == 0 || content.size() < kFixed) return std::nullopt;
  const bool little = (flags & kLittleEndian) != 0;
  const std::size_t at = 4 + Reader{content.subspan(2), little}.number(2);  // octetsToInlineQos
  if (at > content.size()) return std::nullopt;
  auto payload = content.subspan(at);
  if ((flags & kInlineQos) != 0) payload = after(Reader{payload, little});
  if (payload.size() < kEncapsulation) return std::nullopt;
  const bool little_list = payload[1] == 0x03;  // PL_CDR_LE; 0x02: PL_CDR_BE
  const auto text = user_data_in(Reader{payload.subspan(kEncapsulation), little_list});
  return bus::parse_announcement({reinterpret_cast<const char*>(text.data()), text.size()});
}

class Socket {
 public:
  Socket(std::uint32_t domain, const std::vector<std::string>& addresses)
      : descriptor_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)} {
    const int on = 1;
    ::setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    // the DDS vendors set the same option
    ::setsockopt(descriptor_, SOL_SOCKET, SO_REUSEPORT, &on, sizeof on);
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_port = htons(static_cast<std::uint16_t>(bus::first_port(domain)));
    ::inet_pton(AF_INET, kDiscoveryGroup, &own.sin_addr);  // receives only datagrams to the group
    open_ = ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0;
    for (const auto& address : addresses) {
      ip_mreq group{};
      group.imr_multiaddr = own.sin_addr;
      ::inet_pton(AF_INET, address.c_str(), &group.imr_interface);
      ::setsockopt(descriptor_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group);
    }
  }
  Socket(Socket&& other) noexcept : descriptor_{std::exchange(other.descriptor_, -1)}, open_{other.open_} {}
  Socket(const Socket&) = delete;
  ~Socket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  [[nodiscard]] pollfd to_poll() const {
    return {.fd = open_ ? descriptor_ : -1, .events = POLLIN, .revents = 0};
  }

 private:
  int descriptor_;
  bool open_ = false;
};

}  // namespace

std::optional<bus::Announcement> announcement_in(Bytes datagram) {
  constexpr std::size_t kHeader = 20;
  constexpr std::uint8_t kDataMessage = 0x15, kLittleEndian = 0x01;
  if (datagram.size() < kHeader || !std::ranges::equal(datagram.first(4), std::array{'R', 'T', 'P', 'S'}))
    return std::nullopt;
  for (auto rest = datagram.subspan(kHeader); rest.size() >= 4;) {
    const auto kind = rest[0], flags = rest[1];
    std::size_t size = Reader{rest.subspan(2), (flags & kLittleEndian) != 0}.number(2);
    rest = rest.subspan(4);
    if (size == 0 || size > rest.size()) size = rest.size();  // 0: up to the end, 9.4.5.1.3
    if (kind == kDataMessage)
      if (auto found = announcement_of(rest.first(size), flags)) return found;
    rest = rest.subspan(size);
  }
  return std::nullopt;
}

std::vector<Announced> listen_for_announcements(const std::vector<std::string>& addresses,
                                                std::chrono::milliseconds duration) {
  std::vector<Socket> sockets;
  std::vector<pollfd> polled;
  for (std::uint32_t domain = 0; domain < kDomains; ++domain)
    polled.push_back(sockets.emplace_back(domain, addresses).to_poll());
  std::vector<Announced> observed;
  std::array<std::uint8_t, 65536> datagram{};
  const auto end_ns = runtime::monotonic_ns() + std::chrono::nanoseconds{duration}.count();
  constexpr std::size_t kMost = 1000;  // bounds the memory that unknown senders can use
  for (std::int64_t left_ns = 1; left_ns > 0 && !runtime::stop_requested();) {
    left_ns = end_ns - runtime::monotonic_ns();
    ::poll(polled.data(), polled.size(),
           static_cast<int>(std::clamp<std::int64_t>(left_ns / 1'000'000, 0, 100)));
    for (std::uint32_t domain = 0; domain < kDomains; ++domain) {
      if ((polled[domain].revents & POLLIN) == 0) continue;
      sockaddr_in from{};
      socklen_t size = sizeof from;
      const auto bytes = ::recvfrom(polled[domain].fd, datagram.data(), datagram.size(), 0,
                                    reinterpret_cast<sockaddr*>(&from), &size);
      if (bytes <= 0) continue;
      const auto said = announcement_in(Bytes{datagram}.first(static_cast<std::size_t>(bytes)));
      if (!said) continue;
      std::array<char, INET_ADDRSTRLEN> text{};
      ::inet_ntop(AF_INET, &from.sin_addr, text.data(), text.size());
      const Announced one{text.data(), domain, *said};
      if (observed.size() < kMost && std::ranges::find(observed, one) == observed.end())
        observed.push_back(one);
    }
  }
  return observed;
}

}  // namespace crane::doctor
