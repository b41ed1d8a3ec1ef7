#pragma once
/// Discovery of participants. Both vendors must use the same kind of discovery (multicast or unicast).
/// Therefore one rule selects the kind for both.
#include <chrono>
#include <cstdint>
#include <string>

#include "crane/bus/bus.hpp"
#include "crane/bus/ports.hpp"

namespace crane::bus {

/// @return true with a Discovery Server, with explicit peers, and when no interface has multicast (the usual
///   Linux loop-back). Every participant then contacts the known ports of its own host and of the peers
[[nodiscard]] bool discovers_by_unicast(const Options& options);

/// Largest number of participants of one domain on one host with unicast discovery, for both vendors:
/// discovery contacts the ports of the participant numbers below this limit. The ports of higher numbers
/// belong to the next domain. All participants of a process over Cyclone DDS share one number.
inline constexpr std::uint32_t kMostParticipants = most_participants();
/// True for operator tools and monitors: when no number is free, they join without a number, with any free
/// ports. They then discover all participants with a number, but not each other. Without this rule, a program
/// that binds the ports of all numbers could prevent a stop.
[[nodiscard]] bool joins_without_number(const Options& options);
/// @return a UDP port outside the ports of the domains that was free on the first own interface; another
///   process may bind it later
[[nodiscard]] std::uint32_t any_free_port(const Options& options);
/// @return message with cause and remedy for the case that no participant number is free
[[nodiscard]] std::string no_free_number(const Options& options);
/// @return message for the case that the middleware does not state why it could not join
[[nodiscard]] std::string cannot_join(const Options& options);
/// @return true when both ports of the participant number were free on all own interfaces; another
///   process may bind them later
[[nodiscard]] bool has_free_ports(const Options& options, std::uint32_t number);

/// True when samples may leave this computer and datagrams may be lost: with peers, or with an interface
/// other than loop-back. A lost datagram delays all later samples of its topic until the reader requests the
/// datagram after the next heartbeat. With the period kNetworkHeartbeat, Cyclone DDS repairs a sample within
/// its tick.
[[nodiscard]] bool crosses_network(const Options& options);
inline constexpr std::chrono::milliseconds kNetworkHeartbeat{2};
/// On the loop-back interface, a datagram is lost only when a receive buffer is full. The discovery writers
/// of Cyclone DDS use the same period. While the participants of a domain start, each participant sends these
/// heartbeats to all others; with a period of 20 ms, the start of 64 participants takes longer than 12 s
/// (docs/fleet.md).
inline constexpr std::chrono::milliseconds kHeartbeat{100};

}  // namespace crane::bus
