#include "discovery.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace crane::bus {
namespace {

bool has_multicast(const std::string& address) {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return true;
  bool found = false;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(i->ifa_addr)->sin_addr, text.data(),
              text.size());
    found = found || (address == text.data() && (i->ifa_flags & IFF_MULTICAST) != 0);
  }
  freeifaddrs(list);
  return found;
}

/// Binds and releases a UDP port. @param port  0: any. @return the bound port; 0: the port is not free
std::uint32_t bound_port(const std::string& address, std::uint32_t port) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return 0;
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, address.c_str(), &own.sin_addr);
  socklen_t length = sizeof own;
  const bool bound = ::bind(socket, reinterpret_cast<const sockaddr*>(&own), length) == 0 &&
                     ::getsockname(socket, reinterpret_cast<sockaddr*>(&own), &length) == 0;
  ::close(socket);
  return bound ? ntohs(own.sin_port) : 0;
}
bool is_free(const std::string& address, std::uint32_t port) { return bound_port(address, port) != 0; }

}  // namespace

bool has_free_ports(const Options& options, std::uint32_t number) {
  const auto port = unicast_port(options.domain, number);
  return std::ranges::all_of(options.interfaces, [port](const std::string& address) {
    return is_free(address, port) && is_free(address, port + 1);
  });
}

bool joins_without_number(const Options& options) {
  return options.source == crane_SOURCE_OPERATOR || options.source == crane_SOURCE_MONITOR;
}

std::uint32_t any_free_port(const Options& options) { return bound_port(options.interfaces.front(), 0); }

std::string no_free_number(const Options& options) {
  return "domain " + std::to_string(options.domain) + " has no free participant number on " +
         options.interfaces.front() + ": a domain has UDP ports for " + std::to_string(kMostParticipants) +
         " programs per host (" + std::to_string(unicast_port(options.domain, 0)) + " to " +
         std::to_string(unicast_port(options.domain, kMostParticipants) - 1) +
         "; `crane up` with its processes takes 8, with --in-process 3); start this crane with --in-process "
         "or another --domain, or end programs that are left over (`pgrep -a crane`)";
}

std::string cannot_join(const Options& options) {
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  return "cannot join domain " + std::to_string(options.domain) + " on " + options.interfaces.front() +
         "; is the interface up, are UDP ports " + std::to_string(first_port(options.domain)) +
         " and up free, and do " + std::to_string(files.rlim_cur) +
         " open files suffice for this program (`ulimit -n`)?";
}

bool discovers_by_unicast(const Options& options) {
  const auto& own = options.interfaces;
  return !options.discovery_server.empty() || !options.peers.empty() ||
         std::none_of(own.begin(), own.end(), has_multicast);
}

bool crosses_network(const Options& options) {
  return !options.peers.empty() ||
         std::any_of(options.interfaces.begin(), options.interfaces.end(),
                     [](const std::string& address) { return !address.starts_with("127."); });
}

}  // namespace crane::bus
