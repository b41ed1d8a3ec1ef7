#pragma once
/// Finds the participants of every domain from their multicast announcements (RTPS 2.5, 8.5.3 SPDP), so that
/// the doctor finds a crane in a domain that it has not joined.
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/bus/announcement.hpp"

namespace crane::doctor {

struct Announced {
  std::string address;  ///< address of the sender
  std::uint32_t domain = 0;
  bus::Announcement said;
  bool operator==(const Announced&) const = default;
};

/// Decodes the announcement of a program of this project. @return nothing for any other datagram
[[nodiscard]] std::optional<bus::Announcement> announcement_in(std::span<const std::uint8_t> datagram);

/// Listens in all domains on the interfaces with these addresses; returns each participant once. Participants
/// with unicast discovery (loop-back, --peer, --discovery-server) are not found.
[[nodiscard]] std::vector<Announced> listen_for_announcements(const std::vector<std::string>& addresses,
                                                              std::chrono::milliseconds duration);

}  // namespace crane::doctor
