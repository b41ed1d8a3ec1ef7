#pragma once
/// Discovery of participants. Both vendors must use the same kind (multicast or unicast), hence one rule.
#include <chrono>

#include "crane/bus/bus.hpp"

namespace crane::bus {

/// @return true with explicit peers, and when no interface has multicast (the usual Linux loop-back). Every
///   participant then contacts the known ports of its own host and of the peers
[[nodiscard]] bool discovers_by_unicast(const Options& options);

/// True when samples may leave this computer, so that datagrams get lost: an interface that is not the
/// loop-back interface, or peers. A lost datagram delays all later samples of its topic until it has been
/// sent again, and the next heartbeat is what tells the reader. Heartbeats each 20 ms cost the least; on a
/// network they come each kNetworkHeartbeat, so that a sample is repaired within its tick, for about twice
/// the processor time.
[[nodiscard]] bool crosses_network(const Options& options);
inline constexpr std::chrono::milliseconds kHeartbeat{20}, kNetworkHeartbeat{2};

}  // namespace crane::bus
