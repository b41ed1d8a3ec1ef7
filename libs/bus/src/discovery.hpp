#pragma once
/// Discovery of participants. Both vendors must use the same kind of discovery (multicast or unicast).
/// Therefore one rule selects the kind for both.
#include <chrono>

#include "crane/bus/bus.hpp"

namespace crane::bus {

/// @return true with explicit peers, and when no interface has multicast (the usual Linux loop-back). Every
///   participant then contacts the known ports of its own host and of the peers
[[nodiscard]] bool discovers_by_unicast(const Options& options);

/// Largest number of participants of one domain on one host with unicast discovery, for both vendors:
/// discovery contacts the ports of this number of participants. The ports of a domain suffice for 120. The
/// limit is lower, because eight cranes in one domain lost many ticks (docs/benchmarks.md).
inline constexpr std::uint32_t kMostParticipants = 31;

/// True when samples may leave this computer and datagrams may be lost: with peers, or with an interface
/// other than loop-back. A lost datagram delays all later samples of its topic until the reader requests the
/// datagram after the next heartbeat. With the period kNetworkHeartbeat, Cyclone DDS repairs a sample within
/// its tick.
[[nodiscard]] bool crosses_network(const Options& options);
inline constexpr std::chrono::milliseconds kHeartbeat{20}, kNetworkHeartbeat{2};

}  // namespace crane::bus
