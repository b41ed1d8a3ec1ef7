#include "cyclone/domain.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>

namespace crane::bus::cyclone {
namespace {

struct Open {
  dds_entity_t entity = 0;
  std::string configuration;
  int users = 0;
};

struct OpenDomains {
  std::mutex mutex;
  std::map<std::uint32_t, Open> by_number;
};
OpenDomains& open_domains() {
  static OpenDomains domains;
  return domains;
}

/// Usual Linux loop-back has no multicast; Cyclone DDS then discovers by unicast, but complains on every
/// start unless told to.
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

/// Explicit, so that CYCLONEDDS_URI of the environment cannot change what a crane does.
std::string configuration(const Options& options) {
  const auto& own = options.interfaces;
  const bool unicast = !options.peers.empty() || std::none_of(own.begin(), own.end(), has_multicast);
  std::string xml = "<Domain id=\"any\"><General><AllowMulticast>";
  xml += unicast ? "false" : "spdp";
  xml += "</AllowMulticast><Interfaces>";
  for (const auto& address : own) xml += "<NetworkInterface address=\"" + address + "\"/>";
  xml += "</Interfaces></General><Discovery><ParticipantIndex>";
  xml += unicast ? "auto" : "none";
  xml +=
      "</ParticipantIndex><MaxAutoParticipantIndex>30</MaxAutoParticipantIndex>";  // default 9: 10 processes
  if (unicast) {
    xml += "<Peers>";
    for (const auto& peer : options.peers) xml += "<Peer address=\"" + peer + "\"/>";
    for (const auto& address : own) xml += "<Peer address=\"" + address + "\"/>";
    xml += "</Peers>";
  }
  xml += "<LeaseDuration>10s</LeaseDuration></Discovery><Internal>";
  xml += "<HeartbeatInterval min=\"5ms\" minsched=\"5ms\" max=\"1s\">20ms</HeartbeatInterval>";
  xml += "<NackDelay>1ms</NackDelay><PreEmptiveAckDelay>10ms</PreEmptiveAckDelay>";
  xml += "<GenerateKeyhash>true</GenerateKeyhash></Internal></Domain>";  // Fast DDS finds instances by it
  return xml;
}

}  // namespace

dds_entity_t checked_entity(dds_entity_t code, const std::string& what) {
  if (code < 0) throw Error{"Cyclone DDS: " + what + ": " + dds_strretcode(code)};
  return code;
}

Domain::Domain(const Options& options) : number_{options.domain} {
  const std::string wanted = configuration(options);
  OpenDomains& domains = open_domains();
  const std::lock_guard lock{domains.mutex};
  const auto found = domains.by_number.find(number_);
  if (found == domains.by_number.end()) {
    const dds_entity_t entity =
        checked_entity(dds_create_domain(number_, wanted.c_str()),
                       "cannot open domain " + std::to_string(number_) + " on " + options.interfaces.front() +
                           "; is the interface up, and are UDP ports " +
                           std::to_string(7400 + 250 * number_) + " and up free?");
    domains.by_number.emplace(number_, Open{entity, wanted, 1});
    return;
  }
  if (found->second.configuration != wanted)
    throw Error{"Cyclone DDS: this process has domain " + std::to_string(number_) +
                " open with other interfaces or peers; use the same ones, or another domain"};
  ++found->second.users;
}

Domain::~Domain() {
  OpenDomains& domains = open_domains();
  const std::lock_guard lock{domains.mutex};
  const auto found = domains.by_number.find(number_);
  if (--found->second.users > 0) return;
  dds_delete(found->second.entity);
  domains.by_number.erase(found);
}

}  // namespace crane::bus::cyclone
