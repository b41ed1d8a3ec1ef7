#pragma once
/// Options of a bus and of its endpoints; events of an endpoint.
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "crane/topics.hpp"

namespace crane::bus {

enum class Vendor : std::uint8_t { cyclone, fastdds, memory };
[[nodiscard]] std::string_view to_string(Vendor vendor);
/// @return nothing when `name` is not "cyclone", "fastdds" or "memory"
[[nodiscard]] std::optional<Vendor> vendor_from_string(std::string_view name);

/// The bus cannot join the domain, create an entity or use a type. what() names the cause and the remedy.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Ledger;         ///< crane/bus/ledger.hpp
class MemoryNetwork;  ///< connects the buses of an in-process stack; all buses of one stack share one network

/// Absolute paths of one participant's files for DDS Security: PEM, or S/MIME for the last two.
struct Credentials {
  std::string identity_ca, identity_certificate, private_key;
  std::string permissions_ca, governance, permissions;
};

struct Options {
  Vendor vendor = Vendor::cyclone;
  std::uint32_t domain = 0;                          ///< 0..100
  std::string crane = "crane";                       ///< DDS partition, which separates cranes in one domain
  std::string participant = "node";                  ///< name that DDS tools show
  crane_Source source = crane_SOURCE_NONE;           ///< Header.source of every published sample
  std::uint32_t epoch = 0;                           ///< Header.epoch of every published sample
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses to bind to
  std::vector<std::string> peers{};  ///< not empty: unicast discovery of these hosts, no multicast
  /// "HOST" or "HOST:PORT" of a Discovery Server of Fast DDS, which replaces multicast and peers; empty:
  /// none.
  std::string discovery_server{};
  std::shared_ptr<MemoryNetwork> network{};  ///< Vendor::memory only
  /// True: Cyclone DDS sends heartbeats every 2 ms on loop-back, too, instead of every 100 ms.
  /// Publisher::wait_until_acknowledged() then returns about 2 ms after the reception at the latest. Other
  /// vendors ignore this option.
  bool fast_heartbeats = false;
  /// Empty: DDS Security is off, and every program that reaches this bus may write to it. The memory back end
  /// needs no credentials.
  std::optional<Credentials> credentials{};
  /// Loop topics: publishers enter their samples, subscribers report whether a sample was entered
  /// (SampleInfo::entered). Null: there is no ledger, and `entered` is true.
  std::shared_ptr<Ledger> ledger{};
  /// Announced to all participants and part of every CRC. Only tests set another value.
  std::uint32_t messages_version = crane_MESSAGES_VERSION;
};

enum class EventKind : std::uint8_t {
  matched,            ///< a counterpart (reader or writer) was discovered
  unmatched,          ///< a counterpart ended or is no longer reachable
  deadline_missed,    ///< no sample within EndpointOptions::deadline
  liveliness_lost,    ///< a writer has not asserted its liveliness within its lease
  liveliness_gained,  ///< a writer is alive again
  incompatible_qos,   ///< a counterpart was found, but its quality of service does not match
  sample_lost         ///< the middleware lost a sample
};
[[nodiscard]] std::string_view to_string(EventKind kind);

struct Event {
  EventKind kind;
  std::string_view topic;
  int current = 0;  ///< matched, unmatched: number of counterparts; sample_lost: total number of lost samples
  /// incompatible_qos: name of the policy. Cyclone DDS also reports endpoints of other partitions (cranes).
  std::string_view policy;
};
/// Called by a thread of the vendor; must not block.
using EventHandler = std::function<void(const Event&)>;

/// Quality of service of one endpoint beyond that of its topic.
struct EndpointOptions {
  /// Publisher of a loop or script topic (idl/README.md): keeps its samples for readers that join later.
  /// Publishers of log and status topics always keep them. Subscriber: also receives the samples that were
  /// kept before it joined. Subscribers of status topics always receive them.
  bool history = false;
  /// EventKind::deadline_missed when no sample arrives for this time; 0: no deadline. A reader matches only
  /// writers that offer a deadline and a lease at least as short. The memory back end has no clock and
  /// reports neither.
  std::chrono::nanoseconds deadline{0};
  /// Liveliness "manual by topic": publishing asserts it; 0: automatic, with an infinite lease.
  std::chrono::nanoseconds liveliness_lease{0};
  EventHandler on_event{};
};

}  // namespace crane::bus
