#include "wire.hpp"

#include <arpa/inet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netpacket/packet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace crane::hostile {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error{errno, std::generic_category(), what}; }

int packet_socket() { return ::socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP)); }

/// The RTPS message of an IPv4 packet. @return nothing when it holds none
std::optional<Packet> parsed(std::span<const std::uint8_t> packet) {
  constexpr std::size_t kUdpBytes = 8;
  if (packet.size() < 20 || packet[9] != IPPROTO_UDP) return std::nullopt;
  const std::size_t header = (packet[0] & 0xFU) * 4U;
  if (packet.size() < header + kUdpBytes) return std::nullopt;
  Packet result;
  result.to.sin_family = AF_INET;
  std::memcpy(&result.to.sin_addr, &packet[16], 4);
  std::memcpy(&result.to.sin_port, &packet[header + 2], 2);
  result.message.assign(packet.begin() + static_cast<std::ptrdiff_t>(header + kUdpBytes), packet.end());
  return is_rtps(result.message) ? std::optional{result} : std::nullopt;
}

}  // namespace

Ear::Ear(const char* interface) : socket_{packet_socket()} {
  if (socket_ < 0) fail("packet socket");
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_IP);
  address.sll_ifindex = static_cast<int>(::if_nametoindex(interface));
  constexpr int kBuffer_bytes = 32 << 20;
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &kBuffer_bytes, sizeof kBuffer_bytes);
  if (::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) fail("bind");
}
Ear::~Ear() { ::close(socket_); }

bool Ear::permitted() {
  const int trial = packet_socket();
  if (trial >= 0) ::close(trial);
  return trial >= 0;
}

std::optional<Packet> Ear::next(std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  std::array<std::uint8_t, 65536> buffer;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd ready{socket_, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0))) <= 0)
      return std::nullopt;
    sockaddr_ll from{};
    socklen_t size = sizeof from;
    const auto bytes =
        ::recvfrom(socket_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (bytes <= 0 || from.sll_pkttype == PACKET_OUTGOING) continue;  // each packet arrives twice
    if (auto packet = parsed(std::span{buffer}.first(static_cast<std::size_t>(bytes)))) return packet;
  }
}

Mouth::Mouth() : socket_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
  if (socket_ < 0) fail("socket");
  const in_addr loop_back{htonl(INADDR_LOOPBACK)};
  ::setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &loop_back, sizeof loop_back);
}
Mouth::~Mouth() { ::close(socket_); }

void Mouth::send(const Packet& packet) {
  const auto bytes = ::sendto(socket_, packet.message.data(), packet.message.size(), 0,
                              reinterpret_cast<const sockaddr*>(&packet.to), sizeof packet.to);
  if (bytes >= 0) ++sent_;
}

std::set<std::uint16_t> ports_of(pid_t process) {
  std::set<std::string> inodes;
  std::error_code gone;
  for (const auto& file :
       std::filesystem::directory_iterator{"/proc/" + std::to_string(process) + "/fd", gone}) {
    const auto link = std::filesystem::read_symlink(file.path(), gone).string();
    if (link.starts_with("socket:[")) inodes.insert(link.substr(8, link.size() - 9));
  }
  std::set<std::uint16_t> ports;
  std::ifstream table{"/proc/net/udp"};
  std::string line;
  std::getline(table, line);  // names of the columns
  while (std::getline(table, line)) {
    std::istringstream columns{line};
    std::string slot, local, text;
    columns >> slot >> local;
    for (int i = 0; i < 7; ++i) columns >> text;
    columns >> text;  // column 10: the inode
    if (inodes.contains(text))
      ports.insert(static_cast<std::uint16_t>(std::stoul(local.substr(9), nullptr, 16)));
  }
  return ports;
}

long resident_kb(pid_t process) {
  std::ifstream status{"/proc/" + std::to_string(process) + "/status"};
  for (std::string key; status >> key;)
    if (key == "VmRSS:") {
      long kb = 0;
      status >> kb;
      return kb;
    }
  return 0;
}

}  // namespace crane::hostile
