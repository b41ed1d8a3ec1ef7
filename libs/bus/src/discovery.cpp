#include "discovery.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

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

}  // namespace

bool discovers_by_unicast(const Options& options) {
  const auto& own = options.interfaces;
  return !options.peers.empty() || std::none_of(own.begin(), own.end(), has_multicast);
}

bool crosses_network(const Options& options) {
  return !options.peers.empty() ||
         std::any_of(options.interfaces.begin(), options.interfaces.end(),
                     [](const std::string& address) { return !address.starts_with("127."); });
}

}  // namespace crane::bus
