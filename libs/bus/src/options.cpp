#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <thread>

#include "back_end.hpp"
#include "discovery_server.hpp"

namespace crane::bus {
namespace {

std::string text_of(const sockaddr* address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  const auto* ipv4 = reinterpret_cast<const sockaddr_in*>(address);
  inet_ntop(AF_INET, &ipv4->sin_addr, text.data(), text.size());
  return text.data();
}

/// @param flags  of the interface, all of them set: IFF_UP, IFF_RUNNING
std::vector<std::string> addresses_of_this_host(unsigned flags = 0) {
  std::vector<std::string> found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return found;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next)
    if (i->ifa_addr != nullptr && i->ifa_addr->sa_family == AF_INET && (i->ifa_flags & flags) == flags)
      found.push_back(text_of(i->ifa_addr));
  freeifaddrs(list);
  return found;
}

/// A participant on an interface without carrier receives nothing, even after the carrier appears, because
/// the vendors read the interfaces only once. After power-on the carrier appears some seconds after the
/// address.
void await_carrier(const Options& options, std::vector<std::string>& problems) {
  constexpr std::chrono::seconds kPatience{5};
  constexpr std::chrono::milliseconds kPause{50};
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  for (const auto& wanted : options.interfaces)
    for (;;) {
      const auto running = addresses_of_this_host(IFF_UP | IFF_RUNNING);
      if (std::find(running.begin(), running.end(), wanted) != running.end()) break;
      if (std::chrono::steady_clock::now() > deadline) {
        problems.push_back(
            "interfaces: the interface of " + wanted +
            " is down or has no carrier: plug in its cable, set it up (ip link), and start again");
        break;
      }
      std::this_thread::sleep_for(kPause);
    }
}

std::string joined(const std::vector<std::string>& parts, const char* separator) {
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

/// @return empty when the host is unknown
std::string ipv4_of(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (host.empty() || getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) return {};
  std::string address = text_of(found->ai_addr);
  freeaddrinfo(found);
  return address;
}

void check_interfaces(const Options& options, std::vector<std::string>& problems) {
  const auto here = addresses_of_this_host();
  if (options.interfaces.empty())
    problems.push_back("interfaces is empty: name at least one address of this host (" + joined(here, ", ") +
                       ")");
  for (const auto& wanted : options.interfaces)
    if (std::find(here.begin(), here.end(), wanted) == here.end())
      problems.push_back("interfaces: " + wanted + " is not an address of this host; it has " +
                         joined(here, ", "));
  if (problems.empty()) await_carrier(options, problems);
}

/// Replaces the name of the host by its address.
void check_discovery_server(Options& options, std::vector<std::string>& problems) {
  if (options.discovery_server.empty()) return;
  const auto server = discovery_server_in(options.discovery_server);
  const auto address = ipv4_of(server.host);
  if (address.empty() || server.port == 0)
    problems.push_back("discovery_server: '" + options.discovery_server +
                       "' must be HOST or HOST:PORT, with an address or a name this host knows");
  if (options.vendor != Vendor::fastdds)
    problems.push_back(
        "discovery_server: Cyclone DDS cannot use the Discovery Server of Fast DDS; start every "
        "program of the crane with --dds fastdds");
  if (!options.peers.empty()) problems.push_back("discovery_server: give either a server or peers");
  if (options.credentials)
    problems.push_back(
        "discovery_server: the server has no keys; use peers with --secure, or a server with "
        "--insecure on a network of the crane's own");
  options.discovery_server = address + ":" + std::to_string(server.port);
}

}  // namespace

DiscoveryServer discovery_server_in(const std::string& text) {
  DiscoveryServer server;
  const auto colon = text.find(':');
  server.host = text.substr(0, colon);
  if (colon == std::string::npos) return server;
  const auto port = text.substr(colon + 1);
  const auto* const end = port.data() + port.size();
  const auto [stop, error] = std::from_chars(port.data(), end, server.port);
  constexpr std::uint32_t kLargest = 65535;
  if (error != std::errc{} || stop != end || server.port > kLargest) server.port = 0;
  return server;
}

Options checked(Options options) {
  constexpr std::uint32_t kMaxDomain = 100;
  std::vector<std::string> problems;
  if (options.crane.empty()) problems.push_back("crane is empty: give the crane a name");
  if (options.vendor == Vendor::memory) {
    if (!options.network)
      problems.push_back("network is not set: every memory bus of a stack shares one make_memory_network()");
  } else {
    if (options.domain > kMaxDomain)
      problems.push_back("domain = " + std::to_string(options.domain) +
                         ": must be 0..100; the ports of higher domains overlap ephemeral ports");
    check_interfaces(options, problems);
    for (auto& peer : options.peers) {
      const std::string address = ipv4_of(peer);
      if (address.empty())
        problems.push_back("peers: no IPv4 address for '" + peer +
                           "'; give an address or a name this host knows");
      peer = address;
    }
    check_discovery_server(options, problems);
  }
  if (!problems.empty()) throw Error{"bus options: " + joined(problems, "; ")};
  return options;
}

}  // namespace crane::bus
