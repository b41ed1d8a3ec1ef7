#include "cyclone/domain.hpp"

#include <dds/ddsrt/log.h>

#include <atomic>
#include <map>
#include <mutex>

#include "crane/bus/ports.hpp"
#include "discovery.hpp"
#include "vendor_log.hpp"

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

/// The configuration is complete, so that the environment variable CYCLONEDDS_URI has no effect.
/// @param numbered  false: joins without a participant number
std::string configuration(const Options& options, bool numbered = true) {
  const auto& own = options.interfaces;
  const bool unicast = discovers_by_unicast(options);
  std::string xml = "<Domain id=\"any\"><General><AllowMulticast>";
  xml += unicast ? "false" : "spdp";
  xml += "</AllowMulticast><Interfaces>";
  for (const auto& address : own) xml += "<NetworkInterface address=\"" + address + "\"/>";
  xml += "</Interfaces></General><Discovery><ParticipantIndex>";
  xml += unicast && numbered ? "auto" : "none";
  xml += "</ParticipantIndex><MaxAutoParticipantIndex>" + std::to_string(kMostParticipants);
  xml += "</MaxAutoParticipantIndex>";  // Cyclone DDS uses the indices below this number
  if (unicast) {
    xml += "<Peers>";
    for (const auto& peer : options.peers) xml += "<Peer address=\"" + peer + "\"/>";
    for (const auto& address : own) xml += "<Peer address=\"" + address + "\"/>";
    xml += "</Peers>";
  }
  xml += "<LeaseDuration>10s</LeaseDuration></Discovery><Internal>";
  const bool network = crosses_network(options);
  const bool often = network || options.fast_heartbeats;
  const auto heartbeat = std::to_string((often ? kNetworkHeartbeat : kHeartbeat).count()) + "ms";
  const std::string least = often ? "1ms" : "20ms";
  xml += "<HeartbeatInterval min=\"" + least + "\" minsched=\"" + least + "\" max=\"1s\">" + heartbeat;
  xml += "</HeartbeatInterval><NackDelay>";
  xml += network ? "0s" : "1ms";
  xml += "</NackDelay><PreEmptiveAckDelay>10ms</PreEmptiveAckDelay>";
  // A receive thread with one socket ends only when a packet arrives: without the interface, the program
  // would never end. A pipe wakes the one thread of all sockets.
  if (network) xml += "<MultipleReceiveThreads>false</MultipleReceiveThreads>";
  xml +=
      "<GenerateKeyhash>true</GenerateKeyhash></Internal></Domain>";  // Fast DDS identifies instances by it
  return xml;
}

/// Set when Cyclone DDS logs that it has found no free participant index; its return code does not state
/// this.
std::atomic<bool> no_free_index = false;

void report(void* /*unused*/, const dds_log_data_t* entry) {
  const std::string_view line{entry->message, entry->size};
  if (line.find("Failed to find a free participant index") != std::string_view::npos) no_free_index = true;
  // The domain opens shortly before its participant exists. Other threads call this function again.
  if (line.find("Remote secure participant") != std::string_view::npos) return;
  vendor_log("Cyclone DDS", line);
}

std::string cannot_open(const Options& options) {
  return no_free_index ? no_free_number(options) : cannot_join(options);
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
  dds_set_log_sink(report, nullptr);
  const auto found = domains.by_number.find(number_);
  if (found == domains.by_number.end()) {
    no_free_index = false;
    dds_entity_t created = dds_create_domain(number_, wanted.c_str());
    if (created < 0 && no_free_index && joins_without_number(options))
      created = dds_create_domain(number_, configuration(options, false).c_str());
    const dds_entity_t entity = checked_entity(created, created < 0 ? cannot_open(options) : "");
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
